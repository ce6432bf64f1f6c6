#pragma once

#include <memory>
#include <string>

#include "paloc/core/imu_sample.h"
#include "paloc/frontends/finding.h"
#include "paloc/frontends/frontend_settings.h"
#include "paloc/frontends/lidar_frame.h"

namespace paloc {

/// A check of one stream of a recording. It is told what comes, and asked at the end; what it
/// remembers does not grow with the recording.
class DataCheck {
 public:
  virtual ~DataCheck() = default;

  /// Of each observation of the stream, whether it can be read or not, before what is in it.
  virtual void addStamp(TimeNs /*t_ns*/) {}
  virtual void addRefused(TimeNs /*t_ns*/, const std::string& /*reason*/) {}
  virtual void addImu(const ImuSample& /*sample*/) {}
  virtual void addScan(const LidarFrame& /*frame*/) {}

  virtual void report(Findings& findings) const = 0;
};

enum class StreamKind { kLidar, kImu, kOdometry };

/// Which stream a check is for.
struct CheckedStream {
  StreamKind kind = StreamKind::kImu;
  std::string label;

  std::string name() const;  ///< for sentences: "the IMU 'imu'"
  Finding finding(const std::string& check, Severity severity) const;
};

using DataCheckPtr = std::unique_ptr<DataCheck>;

/// Stamps that go backwards, come twice, or are missing.
DataCheckPtr makeStampCheck(const CheckedStream& stream);
/// Rates that are too low or uneven, and gaps.
DataCheckPtr makeRateCheck(const CheckedStream& stream, const FrontendSettings& settings);
/// What cannot be read: values that are not finite, scans without a point.
DataCheckPtr makeRefusedCheck(const CheckedStream& stream);
/// IMU samples that only repeat the one before.
DataCheckPtr makeRepeatedCheck(const CheckedStream& stream);
/// Axes of an IMU that are clipped at a limit.
DataCheckPtr makeSaturationCheck(const CheckedStream& stream);
/// The unit of the specific force, and whether gravity is in it.
DataCheckPtr makeAccelerationCheck(const CheckedStream& stream);
/// Times of the points within a scan.
DataCheckPtr makePointTimesCheck(const CheckedStream& stream);

}  // namespace paloc
