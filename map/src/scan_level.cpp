#include "paloc/map/scan_level.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "paloc/core/errors.h"
#include "paloc/map/prior_map.h"

namespace paloc {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
// A surface counts as level or upright if it is so to this angle; ever less as the idea of up gets
// better.
constexpr double kFirstAngle = 20 * kDegree, kNarrowing = 0.7, kLastAngle = 4 * kDegree;
constexpr std::size_t kMinSurfaces = 50;

// The normals of the scan's flat places, evenly spread over its surfaces.
std::vector<Vec3> normalsOf(const std::vector<Point3f>& points_body) {
  PointCloud cloud;
  cloud.points = points_body;
  MapSettings settings;
  settings.voxel_m = 0.1;  // about the spacing of a scan indoors
  settings.plane_max_radius_m = 0.6;
  settings.side_file = false;
  std::vector<Vec3> normals;
  try {
    const auto scan = PriorMap::build(cloud, settings, "the scan");
    for (std::uint32_t i = 0; i < scan->size(); ++i) {
      const MapPlane plane = scan->plane(i);
      if (!plane.planar()) continue;
      normals.emplace_back(static_cast<double>(plane.nx), static_cast<double>(plane.ny),
                           static_cast<double>(plane.nz));
    }
  } catch (const IoError&) {
    normals.clear();  // hardly any points, or none on a plane
  }
  return normals;
}

}  // namespace

// Up is where level surfaces have their normals, and upright ones have none: the direction u that
// makes sum_level (n . u)^2 - sum_upright (n . u)^2 largest.
std::optional<Vec3> levelOfScan(const std::vector<Point3f>& points_body, const Vec3& up_body) {
  const std::vector<Vec3> normals = normalsOf(points_body);
  Vec3 up = up_body;
  for (double angle = kFirstAngle; angle > kLastAngle; angle *= kNarrowing) {
    Mat3 sum = Mat3::Zero();
    std::size_t surfaces = 0;
    for (const Vec3& normal : normals) {
      const double cosine = std::abs(normal.dot(up));
      const bool level = cosine > std::cos(angle), upright = cosine < std::sin(angle);
      if (!level && !upright) continue;
      sum += (level ? 1.0 : -1.0) * normal * normal.transpose();
      ++surfaces;
    }
    if (surfaces < kMinSurfaces) return std::nullopt;
    const Vec3 best = Eigen::SelfAdjointEigenSolver<Mat3>(sum).eigenvectors().col(2);
    up = best.dot(up) < 0 ? Vec3(-best) : best;
  }
  return up;
}

}  // namespace paloc
