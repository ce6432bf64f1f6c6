#include "paloc/map/scan_thinning.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "voxel_key.h"

namespace paloc {
namespace {

// A bin holds the numbers that share the leading bits of their floating-point form: sixteen bins
// to each doubling.
constexpr int kDroppedBits = 19;
constexpr std::size_t kBins = std::size_t{1} << (31 - kDroppedBits);

std::size_t binOf(float positive) { return std::bit_cast<std::uint32_t>(positive) >> kDroppedBits; }

}  // namespace

// The constant c of the probability: from the farthest bin inwards, points are all kept until those
// that are left can share what is wanted still.
float ScanThinning::constantFor(std::size_t wanted) {
  sums_.assign(kBins, 0);
  counts_.assign(kBins, 0);
  double rest = 0;
  for (const float r_sq : range_sq_) {
    const std::size_t bin = binOf(r_sq);
    sums_[bin] += static_cast<double>(r_sq);
    ++counts_[bin];
    rest += static_cast<double>(r_sq);
  }
  auto left = static_cast<double>(wanted);
  for (std::size_t bin = kBins; bin-- > 0;) {
    if (counts_[bin] == 0) continue;
    const double farthest = static_cast<double>(
        std::bit_cast<float>(static_cast<std::uint32_t>((bin + 1) << kDroppedBits)));
    // With c = left / rest none of the points within this bin is sure to be kept.
    if (left * farthest <= rest) return static_cast<float>(left / rest);
    left -= counts_[bin];
    rest -= sums_[bin];
    if (left <= 0 || rest <= 0) return static_cast<float>(1 / farthest);
  }
  return 1;
}

std::vector<std::uint32_t> ScanThinning::select(std::span<const Point3f> points,
                                                const Vec3& sensor_position,
                                                std::size_t max_points) {
  std::vector<std::uint32_t> kept;
  if (points.size() <= max_points) {
    kept.resize(points.size());
    for (std::uint32_t i = 0; i < kept.size(); ++i) kept[i] = i;
    return kept;
  }
  const Eigen::Vector3f sensor = sensor_position.cast<float>();
  range_sq_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point3f& before = points[i == 0 ? 0 : i - 1];
    const float x = before.x - sensor.x(), y = before.y - sensor.y(), z = before.z - sensor.z();
    const float r_sq = x * x + y * y + z * z;
    range_sq_[i] = r_sq < 1e30F ? r_sq : 0;  // also where it is not a number
  }
  const float c = constantFor(std::max<std::size_t>(max_points, 2) - 1);
  kept.reserve(max_points);
  // Of each unit of the added probabilities one point, at a place drawn anew: equal steps would
  // meet the same lasers again and again.
  double sum = 0;
  std::uint64_t unit = 0;
  double next = 0;
  const auto draw = [&] {
    next = static_cast<double>(unit) + static_cast<double>(hashKey(unit + 1) >> 11) * 0x1p-53;
    ++unit;
  };
  draw();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float probability = c * range_sq_[i];
    const bool sure = probability >= 1;
    if (!sure) sum += static_cast<double>(probability);
    if (!sure && sum <= next) continue;
    while (!sure && sum > next) draw();
    if (kept.size() < max_points) kept.push_back(static_cast<std::uint32_t>(i));
  }
  return kept;
}

}  // namespace paloc
