#include "paloc/tools/synth_fault_injector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/mrpt_time.h"

namespace paloc::synth {
namespace {

using mrpt::obs::CObservationIMU;
using mrpt::obs::TIMUDataIndex;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kStandardGravity = 9.80665;  // m/s2
constexpr std::array<TIMUDataIndex, 3> kAcc = {mrpt::obs::IMU_X_ACC, mrpt::obs::IMU_Y_ACC,
                                               mrpt::obs::IMU_Z_ACC};
constexpr std::array<TIMUDataIndex, 3> kGyro = {mrpt::obs::IMU_WX, mrpt::obs::IMU_WY,
                                                mrpt::obs::IMU_WZ};

template <typename Change>
void changeAxes(CObservationIMU& imu, const std::array<TIMUDataIndex, 3>& axes,
                const Change& change) {
  const Vec3 v = change(Vec3(imu.get(axes[0]), imu.get(axes[1]), imu.get(axes[2])));
  for (std::size_t i = 0; i < 3; ++i) imu.set(axes[i], v[static_cast<int>(i)]);
}

template <typename Change>
void changeBoth(CObservationIMU& imu, const Change& change) {
  changeAxes(imu, kAcc, change);
  changeAxes(imu, kGyro, change);
}

void spoilValues(CObservationIMU& imu, const Fault& fault) {
  const auto scale = [](double factor) {
    return [factor](const Vec3& v) { return Vec3(factor * v); };
  };
  const auto clip = [](double limit) {
    return [limit](const Vec3& v) { return Vec3(v.cwiseMax(-limit).cwiseMin(limit)); };
  };
  switch (fault.kind) {
    case FaultKind::kImuInG:
      return changeAxes(imu, kAcc, scale(1 / kStandardGravity));
    case FaultKind::kGyroInDegrees:
      return changeAxes(imu, kGyro, scale(1 / kDegree));
    case FaultKind::kImuMirrored:
      return changeBoth(imu, [](const Vec3& v) { return Vec3(v.x(), -v.y(), v.z()); });
    case FaultKind::kImuSwapped:
      return changeBoth(imu, [](const Vec3& v) { return Vec3(v.y(), v.x(), v.z()); });
    case FaultKind::kImuTurned: {
      const Mat3 R = so3::exp(-fault.values[0] * kDegree * Vec3::UnitZ());
      return changeBoth(imu, [&](const Vec3& v) { return Vec3(R * v); });
    }
    case FaultKind::kGyroSaturation:
      return changeAxes(imu, kGyro, clip(fault.values[0]));
    case FaultKind::kAccSaturation:
      return changeAxes(imu, kAcc, clip(fault.values[0]));
    default:
      return;
  }
}

void wrapTimesFromEnd(obs::CObservationLidarScan& scan) {
  scan.timestamp = toMrptTime(fromMrptTime(scan.timestamp) + scan.duration_ns);
  for (std::uint32_t& dt : scan.dt_ns) dt -= scan.duration_ns;  // negative: wraps round
}

void scaleTimes(obs::CObservationLidarScan& scan, double factor) {
  const auto scaled = [factor](std::uint32_t t) {
    return static_cast<std::uint32_t>(
        std::min(factor * t, static_cast<double>(std::numeric_limits<std::uint32_t>::max())));
  };
  for (std::uint32_t& dt : scan.dt_ns) dt = scaled(dt);
  scan.duration_ns = scaled(scan.duration_ns);
}

void spoilScan(obs::CObservationLidarScan& scan, const Fault& fault) {
  const auto turn = [&](const Vec3& axis) {
    const Pose turned{Vec3::Zero(), so3::exp(fault.values[0] * kDegree * axis)};
    scan.sensorPoseOnRobot = toMrpt(turned * fromMrpt(scan.sensorPoseOnRobot));
  };
  switch (fault.kind) {
    case FaultKind::kScanStampEnd:
      scan.timestamp = toMrptTime(fromMrptTime(scan.timestamp) + scan.duration_ns);
      return;
    case FaultKind::kExtrinsicsInverse:
      scan.sensorPoseOnRobot = toMrpt(fromMrpt(scan.sensorPoseOnRobot).inverse());
      return;
    case FaultKind::kExtrinsicsYaw:
      return turn(Vec3::UnitZ());
    case FaultKind::kExtrinsicsPitch:
      return turn(Vec3::UnitY());
    case FaultKind::kPointTimesUnit:
      return scaleTimes(scan, fault.values[0]);
    case FaultKind::kPointTimesEqual:
      std::fill(scan.dt_ns.begin(), scan.dt_ns.end(), 0);
      return;
    case FaultKind::kPointTimesFromEnd:
      return wrapTimesFromEnd(scan);
    default:
      return;
  }
}

}  // namespace

TimeNs FaultInjector::rewound(TimeNs t_ns) const {
  for (const Fault& fault : faults_) {
    if (fault.kind != FaultKind::kRewind) continue;
    if (t_ns >= start_ns_ + nsFromSeconds(fault.values[0])) t_ns -= nsFromSeconds(fault.values[1]);
  }
  return t_ns;
}

bool FaultInjector::inGap(FaultKind kind, TimeNs t_ns) const {
  const double t_s = secondsBetween(start_ns_, t_ns);
  return std::any_of(faults_.begin(), faults_.end(), [&](const Fault& fault) {
    return fault.kind == kind && t_s >= fault.values[0] && t_s < fault.values[1];
  });
}

void FaultInjector::passImu(CObservationIMU imu, const Give& give) {
  constexpr std::uint64_t kNonFiniteEvery = 50, kTwiceEvery = 20, kBurst = 8;
  constexpr TimeNs kWithinBurst = 100'000;  // ns from sample to sample
  TimeNs t_ns = fromMrptTime(imu.timestamp);
  if (inGap(FaultKind::kImuGap, t_ns)) return;
  const std::uint64_t index = imu_samples_++;
  int times = 1;
  for (const Fault& fault : faults_) {
    spoilValues(imu, fault);
    if (fault.kind == FaultKind::kNonFinite && index % kNonFiniteEvery == kNonFiniteEvery - 1) {
      imu.set(mrpt::obs::IMU_X_ACC, std::numeric_limits<double>::quiet_NaN());
    } else if (fault.kind == FaultKind::kDuplicates && index % kTwiceEvery == kTwiceEvery - 1) {
      times = 2;
    } else if (fault.kind == FaultKind::kImuRate) {
      if (t_ns < next_thinned_ns_) return;
      next_thinned_ns_ = std::max(next_thinned_ns_, t_ns - nsFromSeconds(1 / fault.values[0])) +
                         nsFromSeconds(1 / fault.values[0]);
    } else if (fault.kind == FaultKind::kImuUneven) {
      // 200 Hz: the first of a burst waits for seven more.
      const auto ahead = static_cast<TimeNs>(kBurst - 1 - index % kBurst);
      t_ns += ahead * (5'000'000 - kWithinBurst);
    } else if (fault.kind == FaultKind::kClockOffset) {
      t_ns += nsFromSeconds(fault.values[0]);
    }
  }
  imu.timestamp = toMrptTime(rewound(t_ns));
  for (int i = 0; i < times; ++i) give(imu);
}

void FaultInjector::passScan(obs::CObservationLidarScan scan, const Give& give) {
  constexpr std::uint64_t kTwiceEvery = 10;
  const TimeNs t_ns = fromMrptTime(scan.timestamp);
  if (inGap(FaultKind::kLidarGap, t_ns)) return;
  const std::uint64_t index = scans_++;
  scan.timestamp = toMrptTime(rewound(t_ns));
  int times = 1;
  for (const Fault& fault : faults_) {
    spoilScan(scan, fault);
    if (fault.kind == FaultKind::kDuplicates && index % kTwiceEvery == kTwiceEvery - 1) times = 2;
  }
  for (int i = 0; i < times; ++i) give(scan);
}

void FaultInjector::passOther(const mrpt::obs::CObservation& observation, const Give& give) {
  const TimeNs t_ns = fromMrptTime(observation.timestamp);
  if (inGap(FaultKind::kOdometryGap, t_ns)) return;
  const auto copy =
      std::dynamic_pointer_cast<mrpt::obs::CObservation>(observation.duplicateGetSmartPtr());
  copy->timestamp = toMrptTime(rewound(t_ns));
  give(*copy);
}

void FaultInjector::pass(const mrpt::obs::CObservation& observation, const Give& give) {
  if (faults_.empty()) return give(observation);
  if (const auto* imu = dynamic_cast<const CObservationIMU*>(&observation)) {
    return passImu(*imu, give);
  }
  if (const auto* scan = dynamic_cast<const obs::CObservationLidarScan*>(&observation)) {
    return passScan(*scan, give);
  }
  passOther(observation, give);
}

}  // namespace paloc::synth
