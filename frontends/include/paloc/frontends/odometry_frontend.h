#pragma once

#include <mrpt/obs/CObservation.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "paloc/core/odometry_frame.h"
#include "paloc/core/unused_counts.h"

namespace paloc {

struct FrontendSettings;

/// An odometry: MRPT observations in, odometry frames and IMU samples out. It never sees the map's
/// answer. Feed observations in the order of the recording; after each, take events until there are none.
class PALOC_EXPORT OdometryFrontend {
 public:
  using Ptr = std::unique_ptr<OdometryFrontend>;

  /// Creates the front-end registered under `name` ("recorded"). Throws ConfigError, naming those
  /// that exist, if there is none.
  static Ptr create(const std::string& name, const FrontendSettings& settings);

  virtual ~OdometryFrontend() = default;

  virtual void add(const mrpt::obs::CObservation& observation) = 0;
  /// No more observations come: what waits for later data is now given out or counted.
  virtual void finish() = 0;
  /// The next event, in order of time, or nothing when more observations are needed.
  virtual std::optional<FrontendEvent> next() = 0;

  /// What was not used so far, and why.
  virtual const UnusedCounts& unused() const = 0;
  /// Sentences for the user, each said once: how point times were read, what looks wrong.
  virtual std::vector<std::string> takeNotes() = 0;
};

}  // namespace paloc
