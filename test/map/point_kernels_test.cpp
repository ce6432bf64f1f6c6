#include "paloc/map/point_kernels.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

namespace paloc {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// Points about the origin, one of them there, with NaN behind the last.
struct Columns {
  Columns(std::size_t count, unsigned seed) : size(count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> within(-1, 1);
    for (std::vector<float>* axis : {&x, &y, &z}) {
      axis->assign((size + 7) / 8 * 8, kNone);
      for (std::size_t i = 0; i < size; ++i) (*axis)[i] = within(random);
    }
    if (size > 0) x[0] = y[0] = z[0] = 0;
  }
  PointColumns all() const { return {x.data(), y.data(), z.data(), size}; }

  std::size_t size;
  std::vector<float> x, y, z;
};

/// What was packed.
struct Packed {
  explicit Packed(std::size_t most) : x(most + 8), y(most + 8), z(most + 8), indices(most + 8) {}
  PackedColumns to() { return {x.data(), y.data(), z.data()}; }
  void cutTo(std::size_t size) {
    for (std::vector<float>* axis : {&x, &y, &z}) axis->resize(size);
    indices.resize(size);
  }
  bool operator==(const Packed&) const = default;

  std::vector<float> x, y, z;
  std::vector<std::uint32_t> indices;
};

std::vector<PointBlock> blocksOf(std::size_t count, unsigned seed) {
  const Columns points(8 * count, seed);
  std::vector<PointBlock> blocks(count);
  for (std::size_t i = 0; i < 8 * count; ++i) {
    PointBlock& block = blocks[i / 8];
    block.x[i % 8] = points.x[i], block.y[i % 8] = points.y[i], block.z[i % 8] = points.z[i];
  }
  return blocks;
}

std::vector<std::uint32_t> everySecond(std::size_t count) {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < count; i += 2) numbers.push_back(i);
  return numbers;
}

constexpr Place3f kPlace{0.1F, -0.2F, 0.05F}, kNormal{0.48F, -0.6F, 0.64F};
constexpr RegionOfPoints kRegion{kPlace, 0.7F, kNormal, -0.3F, 0.4F};

float distanceSq(const Columns& points, std::size_t i) {
  const float dx = points.x[i] - kPlace.x, dy = points.y[i] - kPlace.y, dz = points.z[i] - kPlace.z;
  return dx * dx + dy * dy + dz * dz;
}

class EachSet : public testing::TestWithParam<const PointKernels*> {
 protected:
  const PointKernels& kernels_ = *GetParam();
};

TEST_P(EachSet, SelectsWhatIsWithinTheRadiusInOrder) {
  for (const std::size_t size : {0U, 1U, 7U, 8U, 9U, 61U}) {
    const Columns points(size, 1);
    std::vector<float> expected;
    for (std::size_t i = 0; i < size; ++i) {
      if (distanceSq(points, i) <= 0.7F) expected.push_back(points.x[i] - kPlace.x);
    }
    Packed packed(size);
    packed.cutTo(kernels_.select(points.all(), kPlace, 0.7F, packed.to()));
    EXPECT_EQ(packed.x, expected) << size;
  }
}

TEST_P(EachSet, CountsNoneOfWhatIsMissing) {
  const Columns points(61, 2);
  std::vector<float> distances_sq(64), heights(64);
  kernels_.distancesSq(points.all(), kPlace, distances_sq.data());
  EXPECT_EQ(distances_sq[60], distanceSq(points, 60));
  EXPECT_EQ(kernels_.countUpTo(distances_sq.data(), 61, 1e9F), 61);
  kernels_.heights(points.all(), kNormal, heights.data());
  EXPECT_EQ(heights[0], 0);
  std::int32_t near = 0;
  for (std::size_t i = 0; i < 61; ++i) near += heights[i] * heights[i] < 0.01F ? 1 : 0;
  EXPECT_EQ(kernels_.countNearPlane(points.all(), kNormal, 0.01F), near);
  EXPECT_GT(near, 0);
}

TEST_P(EachSet, SumsAreThoseOfThePointsInTheRegion) {
  const Columns points(61, 3);
  const RegionSums sums = kernels_.sumsIn(points.all(), kRegion);
  double xy = 0, z = 0;
  int count = 0, within = 0;
  for (std::size_t i = 0; i < 61; ++i) {
    if (distanceSq(points, i) > kRegion.radius_sq) continue;
    ++within;
    const float dx = points.x[i] - kPlace.x, dy = points.y[i] - kPlace.y,
                dz = points.z[i] - kPlace.z;
    const float height = dx * kNormal.x + dy * kNormal.y + dz * kNormal.z;
    if (height < kRegion.low || height > kRegion.high) continue;
    ++count;
    xy += static_cast<double>(dx * dy), z += static_cast<double>(dz);
  }
  EXPECT_EQ(sums.count, count);
  EXPECT_EQ(sums.within, within);
  EXPECT_GT(within, count);
  EXPECT_NEAR(static_cast<double>(sums.second[1]), xy, 1e-5);
  EXPECT_NEAR(static_cast<double>(sums.first[2]), z, 1e-5);
  EXPECT_EQ(kernels_.sumsWithin(points.all(), kPlace, kRegion.radius_sq).count, within);
}

TEST_P(EachSet, BoxesAreFoundByTheirDistance) {
  BoxGroup groups[3]{};
  for (int lane = 0; lane < 8; ++lane) {
    for (int axis = 0; axis < 3; ++axis) {
      groups[2].low[axis][lane] = axis == 0 ? static_cast<float>(lane) : 0.0F;
      groups[2].high[axis][lane] = axis == 0 ? static_cast<float>(lane) + 0.5F : 1.0F;
    }
  }
  const std::uint32_t number = 2;
  std::vector<std::uint32_t> near(16);
  near.resize(kernels_.nearBoxes(groups, {&number, 1}, {3.25F, 0.5F, 2}, 1.6F, near.data()));
  EXPECT_EQ(near, (std::vector<std::uint32_t>{16 + 2, 16 + 3, 16 + 4}));
}

INSTANTIATE_TEST_SUITE_P(PointKernels, EachSet,
                         testing::ValuesIn(allPointKernels().begin(), allPointKernels().end()));

// What a map is prepared to must not depend on the machine.
TEST(PointKernels, AllSetsGiveTheSameBytes) {
  const PointKernels& plain = *allPointKernels().front();
  const std::vector<PointBlock> blocks = blocksOf(40, 4);
  const std::vector<std::uint32_t> some = everySecond(blocks.size());
  const Numbers numbers{some.data(), some.size()};
  const RegionAside aside{kPlace, kNormal, 0.01F, 0.25F, 0.3F};
  const Columns points(93, 5);
  for (const PointKernels* other : allPointKernels()) {
    Packed a(8 * some.size()), b(8 * some.size());
    a.cutTo(plain.gather(blocks.data(), numbers, kPlace, 0.8F, a.to()));
    b.cutTo(other->gather(blocks.data(), numbers, kPlace, 0.8F, b.to()));
    EXPECT_GT(a.x.size(), 10U);
    EXPECT_EQ(a, b);
    Packed c(8 * some.size()), d(8 * some.size());
    c.cutTo(plain.gatherAside(blocks.data(), numbers, aside, c.to(), c.indices.data()));
    d.cutTo(other->gatherAside(blocks.data(), numbers, aside, d.to(), d.indices.data()));
    EXPECT_GT(c.x.size(), 10U);
    EXPECT_EQ(c, d);
    EXPECT_EQ(c.indices[0] % 16 / 8, 0U);  // of every second block
    EXPECT_EQ(plain.sumsIn(points.all(), kRegion), other->sumsIn(points.all(), kRegion));
    const NearestOf e = plain.nearest(blocks.data(), blocks.size(), kPlace),
                    f = other->nearest(blocks.data(), blocks.size(), kPlace);
    EXPECT_EQ(e.index, f.index);
    EXPECT_EQ(e.distance_sq, f.distance_sq);
  }
}

}  // namespace
}  // namespace paloc
