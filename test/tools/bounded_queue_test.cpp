#include "paloc/tools/bounded_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <stdexcept>
#include <thread>

namespace paloc {
namespace {

TEST(BoundedQueue, BringsAllItemsInOrderAndHoldsItsBound) {
  constexpr int kItems = 2000;
  BoundedQueue<std::unique_ptr<int>> queue(3);
  std::atomic<int> ahead{0}, most{0};
  std::thread producer([&] {
    for (int i = 0; i < kItems; ++i) {
      ASSERT_TRUE(queue.push(std::make_unique<int>(i)));
      most = std::max(most.load(), ++ahead);
    }
    queue.end();
  });
  for (int i = 0; i < kItems; ++i) {
    const auto item = queue.pop();
    --ahead;
    ASSERT_TRUE(item);
    EXPECT_EQ(**item, i);
  }
  EXPECT_FALSE(queue.pop());
  EXPECT_FALSE(queue.pop());
  producer.join();
  EXPECT_LE(most, 4);  // one more than the bound may be counted before its partner is
}

TEST(BoundedQueue, AnErrorComesAfterTheItemsBeforeIt) {
  BoundedQueue<int> queue(3);
  std::thread producer([&] {
    queue.push(1);
    queue.push(2);
    queue.end(std::make_exception_ptr(std::runtime_error("damaged")));
  });
  producer.join();
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_EQ(queue.pop(), 2);
  EXPECT_THROW(queue.pop(), std::runtime_error);
}

TEST(BoundedQueue, AbandonedItLetsItsProducerGo) {
  BoundedQueue<int> queue(1);
  bool taken = true;
  std::thread producer([&] {
    while (taken) taken = queue.push(7);
  });
  EXPECT_EQ(queue.pop(), 7);
  queue.abandon();
  producer.join();
  EXPECT_FALSE(taken);
}

}  // namespace
}  // namespace paloc
