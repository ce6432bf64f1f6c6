#include "paloc/core/few_point_directions.h"

#include <algorithm>
#include <cmath>

#include "paloc/core/mrpt_pose.h"

namespace paloc {
namespace {

constexpr double kFewShare = 0.03;    // of the points that constrain the best direction
constexpr int kAgreeingScans = 4;     // in a row
constexpr double kSameAxis = 0.9;     // cosine
constexpr double kAgreeSigmas = 3.0;  // of both scans together, and of the motion between them:
constexpr double kMotionM = 0.01, kMotionRad = 0.002;

}  // namespace

// How many scans in a row, this one among them, agree about a direction. The difference is that of
// the two matches less the motion between them (both in the map frame).
int FewPointDirections::scansAgreeing(const Seen& now, const Vec6& difference_map) const {
  const auto same = std::find_if(seen_.begin(), seen_.end(), [&now](const Seen& before) {
    return before.kind == now.kind && std::abs(before.axis_map.dot(now.axis_map)) > kSameAxis;
  });
  if (same == seen_.end()) return 1;
  const bool position = now.kind == DirectionKind::kPosition;
  const double off = now.axis_map.dot(difference_map.segment<3>(static_cast<int>(now.kind)));
  const double sigma = std::hypot(now.sigma, same->sigma, position ? kMotionM : kMotionRad);
  return std::abs(off) <= kAgreeSigmas * sigma ? same->scans + 1 : 1;
}

void FewPointDirections::check(const Pose& T_map_body_last, const Pose& T_map_body_predicted,
                               MapMatch& match) {
  const Pose T_map_body = fromMrpt(match.T_map_body);
  const Pose expected = T_map_body_match_ * (T_map_body_last.inverse() * T_map_body_predicted);
  Vec6 difference = boxminus(T_map_body, expected);
  difference.tail<3>() = (T_map_body.rotation * difference.tail<3>()).eval();
  std::vector<Seen> seen;
  bool withheld = false;
  for (std::size_t i = 0; i < match.directions.size(); ++i) {
    MatchDirection& direction = match.directions[i];
    if (direction.cls == DirectionClass::kNone) continue;
    Seen now{i < 3 ? DirectionKind::kPosition : DirectionKind::kRotation,
             T_map_body.rotation * direction.axis_body, direction.sigma, kAgreeingScans};
    if (direction.share < kFewShare) {
      now.scans = std::min(scansAgreeing(now, difference), kAgreeingScans);
    }
    seen.push_back(now);
    if (now.scans == kAgreeingScans) continue;
    const bool position = now.kind == DirectionKind::kPosition;
    scaleDirection(match.information, now.kind, position ? now.axis_map : direction.axis_body, 0);
    direction.cls = DirectionClass::kNone;
    direction.sigma = kUnknownSigma;
    withheld = true;
  }
  if (withheld) cutToKnown(match.information, match.shared_spread);
  seen_ = std::move(seen);
  T_map_body_match_ = T_map_body;
}

}  // namespace paloc
