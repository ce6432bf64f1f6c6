#include <gtest/gtest.h>

#include "paloc/map/cloud_io.h"

namespace paloc {
namespace {

// A seed that is refused at its first bytes would lead the fuzzer nowhere.
TEST(FuzzSeeds, AreAllRead) {
  const std::filesystem::path seeds = std::filesystem::path(PALOC_SOURCE_DIR) / "test/fuzz/seeds";
  int read = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(seeds)) {
    if (!entry.is_regular_file()) continue;
    EXPECT_LT(entry.file_size(), 10'000U);
    try {
      EXPECT_GT(loadCloud(entry.path()).size(), 0U) << entry.path();
    } catch (const std::exception& e) {
      ADD_FAILURE() << e.what();
    }
    ++read;
  }
  EXPECT_GE(read, 20);
}

}  // namespace
}  // namespace paloc
