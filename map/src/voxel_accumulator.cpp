#include "voxel_accumulator.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"
#include "voxel_key.h"

namespace paloc {
namespace {

constexpr std::uint32_t kEmpty = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kFirstSlots = 1 << 16;
constexpr std::size_t kAhead = 12;  // points whose slot is fetched before it is needed
constexpr std::uint64_t kAxisMask = (1ULL << kVoxelBits) - 1;

// The low corner of a voxel along one axis (m).
double cornerOf(std::uint64_t number, double edge_m) {
  return (static_cast<double>(number) - kVoxelLimit) * edge_m;
}

}  // namespace

VoxelAccumulator::VoxelAccumulator(double edge_m, const MemoryBudget& budget, std::string name)
    : edge_m_(edge_m),
      inverse_(1 / edge_m),
      budget_(budget),
      name_(std::move(name)),
      slots_(emptySlots(kFirstSlots)) {}

void VoxelAccumulator::require(std::size_t more_bytes) const {
  const std::size_t held = pieces_.size() * kPieceCells * sizeof(Cell) + slots_.size() * 4;
  char edge[40];
  std::snprintf(edge, sizeof edge, "%g", edge_m_);
  budget_.require(held + more_bytes, text(name_, ": thinned to voxels of ", edge, " m, it"));
}

void VoxelAccumulator::hashAll(std::span<const Point3f> points) {
  keys_.resize(points.size());
  hashes_.resize(points.size());
  constexpr double kFurthest = kVoxelLimit - 1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point3f& p = points[i];
    const float furthest = std::max(std::abs(p.x), std::max(std::abs(p.y), std::abs(p.z)));
    if (static_cast<double>(furthest) * inverse_ >= kFurthest) {
      char sentence[200];
      std::snprintf(sentence, sizeof sentence,
                    ": a point is %.0f km off, too far for voxels of %g m: remove stray points or "
                    "set a larger voxel",
                    static_cast<double>(furthest) * 1e-3, edge_m_);
      throw IoError(name_ + sentence);
    }
    keys_[i] = voxelIndex(p.x, inverse_) << 2 * kVoxelBits |
               voxelIndex(p.y, inverse_) << kVoxelBits | voxelIndex(p.z, inverse_);
    hashes_[i] = hashKey(keys_[i]);
  }
}

RawArray<std::uint32_t> VoxelAccumulator::emptySlots(std::size_t count) {
  RawArray<std::uint32_t> slots(count);
  std::fill(slots.begin(), slots.end(), kEmpty);
  return slots;
}

void VoxelAccumulator::growSlots() {
  require(2 * slots_.size() * sizeof(slots_[0]));
  RawArray<std::uint32_t> larger = emptySlots(2 * slots_.size());
  const std::size_t mask = larger.size() - 1;
  for (std::size_t i = 0; i < size_; ++i) {
    std::size_t at = hashKey(cell(i).key) & mask;
    while (larger[at] != kEmpty) at = (at + 1) & mask;
    larger[at] = static_cast<std::uint32_t>(i);
  }
  slots_ = std::move(larger);
}

void VoxelAccumulator::growCells() {
  require(kPieceCells * sizeof(Cell));
  if (size_ + kPieceCells >= kEmpty) throw IoError(name_ + ": has too many voxels");
  pieces_.emplace_back(kPieceCells);
}

VoxelAccumulator::Cell& VoxelAccumulator::find(std::uint64_t key, std::uint64_t hash) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = hash & mask;
  for (; slots_[at] != kEmpty; at = (at + 1) & mask) {
    Cell& met = cell(slots_[at]);
    if (met.key == key) return met;
  }
  if (size_ == pieces_.size() * kPieceCells) growCells();
  slots_[at] = static_cast<std::uint32_t>(size_);
  Cell& fresh = cell(size_++);
  fresh = {key, 0, 0, 0, 0, 0};
  return fresh;
}

void VoxelAccumulator::add(std::span<const Point3f> points, std::span<const float> intensity) {
  hashAll(points);
  while (3 * slots_.size() < 4 * (size_ + points.size())) growSlots();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i + kAhead < points.size()) {
      __builtin_prefetch(&slots_[hashes_[i + kAhead] & (slots_.size() - 1)]);
    }
    Cell& c = find(keys_[i], hashes_[i]);
    const float share = 1 / static_cast<float>(++c.points);
    const auto corner = [&](int axis) {
      return cornerOf(keys_[i] >> (2 - axis) * kVoxelBits & kAxisMask, edge_m_);
    };
    const auto offset = [&](float value, int axis) {
      return static_cast<float>(static_cast<double>(value) - corner(axis));
    };
    c.x += (offset(points[i].x, 0) - c.x) * share;
    c.y += (offset(points[i].y, 1) - c.y) * share;
    c.z += (offset(points[i].z, 2) - c.z) * share;
    if (!intensity.empty()) c.intensity += (intensity[i] - c.intensity) * share;
  }
}

void VoxelAccumulator::take(std::vector<Point3f>& points, std::vector<float>* intensity) {
  slots_ = {};
  require(size_ * (sizeof(Point3f) + (intensity != nullptr ? sizeof(float) : 0)));
  points.reserve(size_);
  if (intensity != nullptr) intensity->reserve(size_);
  for (std::size_t i = 0; i < size_; ++i) {
    if (i % kPieceCells == 0 && i > 0) pieces_[i / kPieceCells - 1] = {};
    const Cell& c = cell(i);
    const auto coordinate = [&](float mean, int axis) {
      const std::uint64_t number = c.key >> (2 - axis) * kVoxelBits & kAxisMask;
      return static_cast<float>(cornerOf(number, edge_m_) + static_cast<double>(mean));
    };
    points.push_back({coordinate(c.x, 0), coordinate(c.y, 1), coordinate(c.z, 2)});
    if (intensity != nullptr) intensity->push_back(c.intensity);
  }
  pieces_.clear();
  size_ = 0;
  slots_ = emptySlots(kFirstSlots);
}

}  // namespace paloc
