#include "start_region.h"

#include <numbers>

#include "paloc/core/mrpt_pose.h"

namespace paloc {
namespace {

// The smallest turn that makes `up` (unit, outer frame) point up.
Mat3 levelling(const Vec3& up) {
  return Quat(Eigen::Quaterniond::FromTwoVectors(up, Vec3::UnitZ())).toRotationMatrix();
}

}  // namespace

Vec3 upOf(const StartGuess& guess) {
  if (!guess.T_map_body) return Vec3::UnitZ();
  return fromMrpt(*guess.T_map_body).rotation.transpose() * Vec3::UnitZ();
}

Pose levelled(const StartGuess& guess) {
  Pose rough = fromMrpt(*guess.T_map_body);
  if (guess.up_body) rough.rotation = levelling(rough.rotation * *guess.up_body) * rough.rotation;
  return rough;
}

StartRegion startRegion(const StartGuess& guess, const Vec3& origin, const SearchBox& everywhere,
                        const MatcherSettings& settings) {
  StartRegion region{everywhere, Mat3::Identity(), std::nullopt};
  Vec3 around = Vec3::Zero();
  double reach_m = 0;
  if (guess.T_map_body) {
    const Pose rough = levelled(guess);
    region.R_level_body = rough.rotation;
    around = rough.position - origin;
    region.rough = Pose{around, rough.rotation};
    reach_m = settings.start_reach_m;
    region.box.yaw_low = -settings.start_reach_rad;
    region.box.yaw_high = settings.start_reach_rad;
  } else if (guess.position_map) {
    around = *guess.position_map - origin;
    reach_m = settings.start_position_reach_m;
  }
  if (reach_m > 0) {
    region.box.low = around - Vec3::Constant(reach_m);
    region.box.high = around + Vec3::Constant(reach_m);
  }
  if (guess.up_body && !guess.T_map_body) {
    region.R_level_body = levelling(*guess.up_body);
  }
  return region;
}

}  // namespace paloc
