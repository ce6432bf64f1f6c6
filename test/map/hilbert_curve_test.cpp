#include "paloc/map/hilbert_curve.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <vector>

namespace paloc {
namespace {

using Voxel = std::array<std::uint32_t, 3>;

// All voxels, by their places.
std::vector<Voxel> alongCurve(int bits) {
  const std::uint32_t edge = 1U << bits;
  std::vector<Voxel> voxels(std::size_t{1} << (3 * bits), Voxel{edge, edge, edge});
  const HilbertCurve curve;
  for (std::uint32_t x = 0; x < edge; ++x) {
    for (std::uint32_t y = 0; y < edge; ++y) {
      for (std::uint32_t z = 0; z < edge; ++z) voxels.at(curve.place(x, y, z, bits)) = {x, y, z};
    }
  }
  return voxels;
}

class OfBits : public testing::TestWithParam<int> {};

// Odd and even numbers of bits take other ways through the tables.
TEST_P(OfBits, PassesThroughEachVoxelOnceFromOneToTheNext) {
  const std::vector<Voxel> voxels = alongCurve(GetParam());
  EXPECT_EQ(voxels.front(), (Voxel{0, 0, 0}));
  for (std::size_t i = 1; i < voxels.size(); ++i) {
    int apart = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      apart += std::abs(static_cast<int>(voxels[i][axis]) - static_cast<int>(voxels[i - 1][axis]));
    }
    ASSERT_EQ(apart, 1) << "at " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(HilbertCurve, OfBits, testing::Values(1, 2, 3, 4, 5));

TEST(HilbertCurve, HasPlacesForTheLargestNumbers) {
  const HilbertCurve curve;
  constexpr std::uint32_t kLast = (1U << 21) - 1;
  EXPECT_EQ(curve.place(0, 0, 0, 21), 0U);
  const std::uint64_t end = curve.place(kLast, 0, 0, 21);  // it leaves along the first axis
  EXPECT_EQ(end, (std::uint64_t{1} << 63) - 1);
}

}  // namespace
}  // namespace paloc
