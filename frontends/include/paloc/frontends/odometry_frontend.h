#pragma once

#include <mrpt/obs/CObservation.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "paloc/core/odometry_frame.h"
#include "paloc/core/stage_timer.h"
#include "paloc/core/unused_counts.h"

namespace paloc {

struct FrontendSettings;

/// An odometry: MRPT observations in, odometry frames and IMU samples out. It never sees the map's
/// answer. Feed observations in the order of the recording; after each, take events until there are
/// none.
class PALOC_EXPORT OdometryFrontend {
 public:
  using Ptr = std::unique_ptr<OdometryFrontend>;

  /// Creates the front-end registered under `name` ("recorded", "fast_lio", "lio_sam"). Throws
  /// ConfigError, naming those that exist, if there is none.
  static Ptr create(const std::string& name, const FrontendSettings& settings);

  using Factory = std::function<Ptr(const FrontendSettings&)>;
  /// Makes a front-end known by name; a shared library does so when it is loaded. Throws
  /// ConfigError if the name is taken.
  static void registerFrontend(const std::string& name, Factory factory);
  static std::vector<std::string> names();  ///< those registered, in order of the alphabet

  virtual ~OdometryFrontend() = default;

  virtual void add(const mrpt::obs::CObservation& observation) = 0;
  /// No more observations come: what waits for later data is now given out or counted.
  virtual void finish() = 0;
  /// The next event, in order of time, or nothing when more observations are needed. The IMU
  /// samples up to and including the first at or after a frame's `t_ns` precede the frame, where
  /// the recording has them: a state at the frame's time can then be interpolated.
  virtual std::optional<FrontendEvent> next() = 0;

  /// What was not used so far, and why.
  virtual const UnusedCounts& unused() const = 0;
  /// Sentences for the user, each said once: how point times were read, what looks wrong.
  virtual std::vector<std::string> takeNotes() = 0;
  /// Known after finish(): what keeps the result from being what was asked for, a sentence each (a
  /// stream that was asked for by its label is not there; no scan could be used).
  virtual std::vector<std::string> problems() const { return {}; }

  /// Is told of the stages of the work, where the front-end tells any; null for none.
  virtual void setStageTimer(StageTimer* /*timer*/) {}
  /// Memory of the front-end's own map (bytes); 0 if it has none.
  virtual std::size_t mapBytes() const { return 0; }
};

}  // namespace paloc
