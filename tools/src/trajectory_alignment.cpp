#include "paloc/tools/trajectory_alignment.h"

#include <Eigen/SVD>
#include <cmath>

#include "paloc/core/errors.h"

namespace paloc {
namespace {

// A spread below this share of the largest does not fix a rotation: it is rounding, not motion.
constexpr double kMinSpreadRatio = 1e-10;

struct PositionMoments {
  Vec3 mean_reference = Vec3::Zero();
  Vec3 mean_estimate = Vec3::Zero();
  Mat3 cross = Mat3::Zero();  ///< mean of (reference - its mean) (estimate - its mean)^T, m2
};

PositionMoments momentsOf(const std::vector<MatchedPose>& matched) {
  PositionMoments m;
  const auto n = static_cast<double>(matched.size());
  for (const MatchedPose& pair : matched) {
    m.mean_reference += pair.reference.position / n;
    m.mean_estimate += pair.estimate.position / n;
  }
  for (const MatchedPose& pair : matched) {
    m.cross += (pair.reference.position - m.mean_reference) *
               (pair.estimate.position - m.mean_estimate).transpose() / n;
  }
  return m;
}

Mat3 leastSquaresRotation(const Mat3& cross) {
  const Eigen::JacobiSVD<Mat3> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3 spread = svd.singularValues();
  if (!(spread[1] > kMinSpreadRatio * spread[0])) {
    throw UsageError(
        "the matched positions lie on one line, which leaves --align se3 undetermined; "
        "use --align yaw, origin or none");
  }
  const double handedness = svd.matrixU().determinant() * svd.matrixV().determinant();
  const Vec3 signs(1, 1, handedness < 0 ? -1 : 1);
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

// The angle that maximizes the trace of the cross moments turned about z.
Mat3 leastSquaresYaw(const Mat3& cross) {
  const double cosine_part = cross(0, 0) + cross(1, 1);
  const double sine_part = cross(1, 0) - cross(0, 1);
  if (!(std::hypot(cosine_part, sine_part) > kMinSpreadRatio * cross.norm())) {
    throw UsageError(
        "the matched positions do not spread horizontally, which leaves --align yaw "
        "undetermined; use --align origin or none");
  }
  return Eigen::AngleAxisd(std::atan2(sine_part, cosine_part), Vec3::UnitZ()).toRotationMatrix();
}

Pose leastSquaresAlignment(const std::vector<MatchedPose>& matched, Alignment alignment) {
  if (matched.size() < 3) {
    throw UsageError(
        "an alignment by least squares needs at least 3 matched poses; use --align "
        "origin or none");
  }
  const PositionMoments m = momentsOf(matched);
  Pose result;
  result.rotation =
      alignment == Alignment::kYaw ? leastSquaresYaw(m.cross) : leastSquaresRotation(m.cross);
  result.position = m.mean_reference - result.rotation * m.mean_estimate;
  return result;
}

}  // namespace

std::string toString(Alignment alignment) {
  switch (alignment) {
    case Alignment::kNone:
      return "none";
    case Alignment::kSe3:
      return "se3";
    case Alignment::kYaw:
      return "yaw";
    case Alignment::kOrigin:
      return "origin";
  }
  return "unknown";
}

Pose alignmentOf(const std::vector<MatchedPose>& matched, Alignment alignment) {
  if (alignment == Alignment::kNone || matched.empty()) return {};
  if (alignment == Alignment::kOrigin) {
    return matched.front().reference * matched.front().estimate.inverse();
  }
  return leastSquaresAlignment(matched, alignment);
}

std::vector<MatchedPose> aligned(std::vector<MatchedPose> matched,
                                 const Pose& T_reference_estimate) {
  for (MatchedPose& pair : matched) pair.estimate = T_reference_estimate * pair.estimate;
  return matched;
}

}  // namespace paloc
