#pragma once

#include <vector>

#include "near_points.h"
#include "paloc/map/map_plane.h"

namespace paloc {

/// Fits a plane to the neighbours of a point (relative to it, the point itself included) by
/// principal components. Where they lie thicker than one clean surface: the face that most of them
/// lie on is sought, the two faces of a thin wall are told apart by the gap between them, the face
/// of the point itself is kept, and the fit is repeated without what lies off it. Not planar: too
/// few points, too thick, a line, an edge or a bush (thickness against width), or a point that lies
/// off the plane of its own neighbours. One object serves one thread.
class PlaneFit {
 public:
  /// A face among several: heights over it, in thicknesses of a clean surface, and the share of the
  /// points that must lie on it.
  static constexpr float kFaceWithin = 3, kFaceShare = 0.5F;
  /// Share of the points from which the rest are strays: of fewer, there may be an edge.
  static constexpr float kWholeShare = 0.8F;

  explicit PlaneFit(const PlaneFitLimits& limits) : limits_(limits) {}

  /// None of the points is further off than the radius.
  MapPlane operator()(const NearPoints& points, float radius_sq);

 private:
  struct Band {
    float low, high;
  };

  double cleanVariance() const { return limits_.clean_thickness_m * limits_.clean_thickness_m; }
  bool findConsensus(const NearPoints& points, float near_sq, Eigen::Vector3f& normal) const;
  PlaneMoments momentsOnFace(const NearPoints& points, const Eigen::Vector3f& normal) const;
  bool meetsAnother(const std::vector<float>& heights_off) const;
  PlaneMoments withoutEdges(const NearPoints& points, const PlaneMoments& face, float radius_sq);
  Band ownFace(const NearPoints& points, const PlaneMoments& m);

  PlaneFitLimits limits_;
  std::vector<float> heights_, sorted_;
  std::vector<Eigen::Vector3f> on_, off_;  // a face
};

}  // namespace paloc
