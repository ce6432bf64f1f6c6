#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "paloc/core/export.h"
#include "paloc/map/box_group.h"
#include "paloc/map/point_block.h"

namespace paloc {

/// Points whose coordinates (m) lie side by side; behind the last one up to the next multiple of
/// eight stand NaN, which no comparison holds for.
struct PointColumns {
  const float *x, *y, *z;
  std::size_t size;
};

/// Where points are written to, one after the other. There must be room for eight more than will
/// be.
struct PackedColumns {
  float *x, *y, *z;
};

struct Place3f {
  float x, y, z;
};

/// The points no further from a place than a radius whose height over the plane through the place
/// with that normal is in [low, high].
struct RegionOfPoints {
  Place3f from;
  float radius_sq;  // m2
  Place3f normal;
  float low, high;  // m
};

/// Of blocks or groups, in an array of all of them.
struct Numbers {
  const std::uint32_t* first;
  std::size_t count;
};

/// What lies at a distance from a plane of which the square is in [least_sq, most_sq], to either
/// side, and no further aside from the place on it than the root of `aside_sq` (m2).
struct RegionAside {
  Place3f place, normal;
  float least_sq, most_sq, aside_sq;
};

/// Of the points in a region, about its place (m, m2).
struct RegionSums {
  std::int32_t count;   // in the region
  std::int32_t within;  // within its radius, whatever the height
  float first[3];       // x, y, z
  float second[6];      // xx, xy, xz, yy, yz, zz

  bool operator==(const RegionSums&) const = default;
};

/// Which of many points is the nearest, and the square of its distance (m2).
struct NearestOf {
  std::uint32_t index;
  float distance_sq;
};

/// The inner loops of what is done with the points about a place, eight points side by side. There
/// is a set for plain x86-64 and one for machines with AVX2, from the same text
/// (point_kernels.inl): each lane has the same operations in the same order, none is contracted, so
/// that both give the same bytes.
struct PointKernels {
  /// The nearest to a place of the points of consecutive blocks, counted from the first; of equally
  /// near ones that of the lowest number modulo eight, and the first of these.
  NearestOf (*nearest)(const PointBlock* blocks, std::size_t count, const Place3f& place);
  /// The boxes of these groups that are nearer to a place than the root of `reach_sq`, in their
  /// order, numbered through all groups; how many. `near` has room for all of them.
  std::size_t (*nearBoxes)(const BoxGroup* groups, const Numbers& numbers, const Place3f& place,
                           float reach_sq, std::uint32_t* near);
  /// Of the points of these blocks those nearer to a place than the root of `reach_sq`, relative to
  /// it; their number.
  std::size_t (*gather)(const PointBlock* blocks, const Numbers& numbers, const Place3f& place,
                        float reach_sq, const PackedColumns& to);
  /// Of the points of these blocks those that lie over a plane or under it, relative to the place
  /// that it goes through, and which they are, numbered through all blocks; how many.
  std::size_t (*gatherAside)(const PointBlock* blocks, const Numbers& numbers,
                             const RegionAside& region, const PackedColumns& to,
                             std::uint32_t* indices);
  /// Of points those no further from a place than the root of `radius_sq`, relative to it; their
  /// number.
  std::size_t (*select)(const PointColumns& points, const Place3f& from, float radius_sq,
                        const PackedColumns& to);
  /// The square of the distance of each point from a place, and of the NaN behind them.
  void (*distancesSq)(const PointColumns& points, const Place3f& from, float* distances_sq);
  /// How many of the values are no larger; `size` is rounded up to a multiple of eight.
  std::int32_t (*countUpTo)(const float* values, std::size_t size, float largest);
  /// The height of each point over the plane through the origin, and of the NaN behind them.
  void (*heights)(const PointColumns& points, const Place3f& normal, float* heights);
  /// Of how many points the square of `normal . point` is less than that. The normal may have any
  /// length.
  std::int32_t (*countNearPlane)(const PointColumns& points, const Place3f& normal,
                                 float within_sq);
  RegionSums (*sumsIn)(const PointColumns& points, const RegionOfPoints& region);
  RegionSums (*sumsWithin)(const PointColumns& points, const Place3f& from, float radius_sq);
};

/// All that this machine can run, the plainest first, the quickest last.
PALOC_EXPORT std::span<const PointKernels* const> allPointKernels();
/// The quickest.
PALOC_EXPORT const PointKernels& pointKernels();

}  // namespace paloc
