#include "paloc/map/scan_averaging.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace paloc {
namespace {

// Rays are sorted into the cells of a cube about the sensor, some 1.8 degrees wide in the middle of
// a face and half of that at its corners.
constexpr std::size_t kCellsAcross = 64;
constexpr std::size_t kCells = 6 * kCellsAcross * kCellsAcross;
// Of a return from its seed: farther apart on a wall, it may be on another one.
constexpr float kReachM = 0.08F;
// Of the returns, each summed up by itself: so many whatever the threads, for the same sums.
constexpr std::size_t kParts = 8;
constexpr double kNoiseSigmas = 3;  // of the difference of two ranges

inline std::size_t cellOf(const Point3f& ray) {
  const float ax = std::abs(ray.x), ay = std::abs(ray.y), az = std::abs(ray.z);
  const bool x_leads = ax >= ay && ax >= az, y_leads = !x_leads && ay >= az;
  const float lead = x_leads ? ray.x : y_leads ? ray.y : ray.z;
  const float u = x_leads ? ray.y : y_leads ? ray.z : ray.x;
  const float v = x_leads ? ray.z : y_leads ? ray.x : ray.y;
  const std::size_t face = (x_leads ? 0U : y_leads ? 2U : 4U) + (lead < 0 ? 1U : 0U);
  // At the sensor itself there is no direction: any cell will do.
  const float half = 0.5F * kCellsAcross / std::max(std::abs(lead), 1e-6F);
  const auto place = [half](float along) {
    const float cell = along * half + 0.5F * kCellsAcross;
    // Also where that is not a number.
    const float bounded = cell > 0 ? std::min(cell, kCellsAcross - 1.0F) : 0.0F;
    return static_cast<std::size_t>(static_cast<std::int32_t>(bounded));  // the quicker way
  };
  return (face * kCellsAcross + place(u)) * kCellsAcross + place(v);
}

Point3f between(const Point3f& from, const Point3f& to) {
  return {to.x - from.x, to.y - from.y, to.z - from.z};
}

float normSq(const Point3f& p) { return p.x * p.x + p.y * p.y + p.z * p.z; }

}  // namespace

AveragedPoints AveragedPoints::everyNth(std::size_t count) const {
  const std::size_t step = std::max<std::size_t>(points.size() / count, 1);
  AveragedPoints some;
  for (std::size_t i = 0; i < points.size(); i += step) {
    some.points.push_back(points[i]);
    some.returns.push_back(returns[i]);
  }
  return some;
}

void inTurn(std::size_t count, const std::function<void(std::size_t)>& job) {
  for (std::size_t i = 0; i < count; ++i) job(i);
}

void ScanAveraging::sortSeeds(std::span<const Point3f> returns,
                              std::span<const std::uint32_t> seeds, const Point3f& sensor) {
  first_in_cell_.assign(kCells, -1);
  seeds_.clear();
  for (const std::uint32_t index : seeds) {
    Seed seed;
    seed.ray = between(sensor, returns[index]);
    seed.range = std::sqrt(normSq(seed.ray));
    std::int32_t& first = first_in_cell_[cellOf(seed.ray)];
    seed.next = first;
    first = static_cast<std::int32_t>(seeds_.size());
    seeds_.push_back(seed);
  }
}

// Adds each of the returns to its seed.
void ScanAveraging::sumUp(std::span<const Point3f> returns, const Point3f& sensor, float same_range,
                          std::span<Sum> sums) const {
  const float reach_sq = kReachM * kReachM + same_range * same_range;
  for (const Point3f& point : returns) {
    const Point3f ray = between(sensor, point);
    std::int32_t nearest = -1;
    float nearest_sq = reach_sq;
    for (std::int32_t k = first_in_cell_[cellOf(ray)]; k >= 0;) {
      const Seed& seed = seeds_[static_cast<std::size_t>(k)];
      const float apart_sq = normSq(between(seed.ray, ray));
      if (apart_sq < nearest_sq && std::abs(std::sqrt(normSq(ray)) - seed.range) < same_range) {
        nearest = k;
        nearest_sq = apart_sq;
      }
      k = seed.next;
    }
    if (nearest < 0) continue;
    const Point3f& seed_ray = seeds_[static_cast<std::size_t>(nearest)].ray;
    Sum& sum = sums[static_cast<std::size_t>(nearest)];
    sum.x += ray.x - seed_ray.x;
    sum.y += ray.y - seed_ray.y;
    sum.z += ray.z - seed_ray.z;
    ++sum.count;
  }
}

AveragedPoints ScanAveraging::average(std::span<const Point3f> returns,
                                      std::span<const std::uint32_t> seeds,
                                      const Vec3& sensor_position, double range_noise_m,
                                      const RunJobs& run) {
  const Point3f sensor{static_cast<float>(sensor_position.x()),
                       static_cast<float>(sensor_position.y()),
                       static_cast<float>(sensor_position.z())};
  const auto same_range = static_cast<float>(kNoiseSigmas * std::numbers::sqrt2 * range_noise_m);
  sortSeeds(returns, seeds, sensor);
  sums_.resize(kParts * seeds_.size());
  const std::size_t part_size = (returns.size() + kParts - 1) / kParts;
  run(kParts, [&](std::size_t part) {
    const std::size_t begin = std::min(part * part_size, returns.size());
    const std::size_t size = std::min(part_size, returns.size() - begin);
    const auto sums = std::span(sums_).subspan(part * seeds_.size(), seeds_.size());
    std::fill(sums.begin(), sums.end(), Sum{});
    sumUp(returns.subspan(begin, size), sensor, same_range, sums);
  });
  AveragedPoints averaged;
  averaged.points.reserve(seeds_.size());
  averaged.returns.reserve(seeds_.size());
  for (std::size_t k = 0; k < seeds_.size(); ++k) {
    Sum sum;
    for (std::size_t part = 0; part < kParts; ++part) {
      const Sum& more = sums_[part * seeds_.size() + k];
      sum.x += more.x, sum.y += more.y, sum.z += more.z;
      sum.count += more.count;
    }
    const int count = std::max(sum.count, 1);
    const float share = 1 / static_cast<float>(count);
    const Point3f& own = returns[seeds[k]];
    averaged.points.push_back(
        {own.x + share * sum.x, own.y + share * sum.y, own.z + share * sum.z});
    averaged.returns.push_back(static_cast<std::uint16_t>(std::min(count, 65535)));
  }
  return averaged;
}

}  // namespace paloc
