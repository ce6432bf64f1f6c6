#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/frontends/odometry_reader.h"

namespace paloc {

/// When two poses of an odometry do not belong to one motion.
struct OdometryLimits {
  double max_gap_s = 0.5;            ///< poses further apart are not interpolated
  double max_speed_mps = 20;         ///< a faster step is a jump: a reset, or a loop closure
  double max_rate_radps = 10;        ///< likewise of the rotation
  double max_extrapolation_s = 0.1;  ///< beyond the end of a stretch, at the speed of its last step
};

/// A stream of odometry poses, cut into stretches at gaps and jumps.
class PALOC_EXPORT OdometryTrack {
 public:
  /// The pose at a time.
  struct Lookup {
    Pose T_odom_body;
    int stretch = 0;  ///< motions are known only between times of the same stretch
    bool extrapolated = false;
  };

  explicit OdometryTrack(const OdometryLimits& limits) : limits_(limits) {}

  /// Appends a pose, which must be later than those before.
  void add(const OdometryPose& pose);

  /// The pose at a time: exactly the stream's where stamps coincide, else interpolated (straight
  /// line and slerp), or extrapolated within the limit; nothing before the stream, in a gap or
  /// across a jump.
  std::optional<Lookup> at(TimeNs t_ns) const;

  /// The stream's own poses strictly between two times.
  std::vector<OdometryPose> between(TimeNs from_ns, TimeNs to_ns) const;

  /// Covariance of the motion T_from^-1 T_to in the tangent space [position in the body frame at
  /// `from_ns`, rotation on the right], if the stream tells covariances: the sum of the steps',
  /// each moved to the end by the rigid motion that followed it; steps partly within count by their
  /// share.
  std::optional<Mat6> motionCovariance(TimeNs from_ns, TimeNs to_ns) const;

  bool empty() const { return poses_.empty(); }
  TimeNs newestNs() const { return poses_.back().pose.t_ns; }  ///< of a track that is not empty
  int gaps() const { return gaps_; }
  int jumps() const { return jumps_; }
  double longestGapS() const { return longest_gap_s_; }

  /// Forgets what lookups at `t_ns` and later do not need.
  void forgetBefore(TimeNs t_ns);

 private:
  struct Entry {
    OdometryPose pose;
    int stretch = 0;
  };

  /// Index of the first pose at or after a time; poses_.size() if there is none.
  std::size_t lowerBound(TimeNs t_ns) const;
  std::optional<Lookup> extrapolate(TimeNs t_ns, std::size_t last) const;
  int stretchOfNext(const OdometryPose& pose);

  OdometryLimits limits_;
  std::deque<Entry> poses_;
  int gaps_ = 0, jumps_ = 0;
  double longest_gap_s_ = 0;
};

}  // namespace paloc
