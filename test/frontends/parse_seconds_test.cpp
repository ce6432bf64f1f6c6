#include <gtest/gtest.h>

#include "paloc/frontends/tum_file.h"

namespace paloc {
namespace {

TEST(ParseSeconds, IsExactToTheNanosecond) {
  const std::pair<const char*, TimeNs> cases[] = {
      {"1645002364.537699938", 1645002364537699938},
      {"0", 0},
      {"-0.000000001", -1},
      {"+2.5", 2'500'000'000},
      {".5", 500'000'000},
      {"3.", 3'000'000'000},
      {"1.4e-9", 1},
      {"1.5e-9", 2},
      {"0.49999999949", 499'999'999},
      {"0.4999999995", 500'000'000},
      {"-0.4999999995", -500'000'000},
      {"1.645002364537699938e+09", 1645002364537699938},
      {"1645002364537699938E-9", 1645002364537699938},
      {"9223372036.854775807", 9223372036854775807},
      {"0e10000", 0},
      {"0.0000e300", 0},
      {"1e-5000", 0},
      {"0001.5", 1'500'000'000},
  };
  for (const auto& [text, expected] : cases) {
    TimeNs t_ns = -7;
    EXPECT_TRUE(parseSeconds(text, t_ns)) << text;
    EXPECT_EQ(t_ns, expected) << text;
  }
}

TEST(ParseSeconds, RefusesWhatIsNotAFiniteDecimal) {
  for (const char* text : {"", " ", "-", ".", "1.2.3", "1s", " 1", "1 ", "nan", "inf", "0x10", "1e",
                           "1e+", "1e+-3", "1e99", "9223372036.854775808", "1,5", "e5"}) {
    TimeNs t_ns = 0;
    EXPECT_FALSE(parseSeconds(text, t_ns)) << text;
  }
}

}  // namespace
}  // namespace paloc
