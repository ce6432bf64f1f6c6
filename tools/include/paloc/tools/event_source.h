#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "paloc/frontends/data_checks.h"
#include "paloc/frontends/odometry_frontend.h"
#include "paloc/frontends/rawlog_stream.h"
#include "paloc/tools/bounded_queue.h"
#include "paloc/tools/replay.h"

namespace paloc {

/// Some events of a front-end, in order, and how far the recording has been read with them.
struct EventBatch {
  std::vector<FrontendEvent> events;
  std::uint64_t frames = 0;        ///< among these
  std::vector<std::string> notes;  ///< sentences for the user that came up meanwhile
  double share = 0;                ///< of the recording's bytes, 0..1
  double recording_s = 0;          ///< time since the recording's first observation
};

/// The first half of a replay: recording and front-end, up to the events that the estimator takes.
/// Knows nothing of the map. Checks the data on the way, as far as that is cheap: what is found are
/// notes of the last batch. The same batches come whether it runs ahead in a thread or not.
class EventSource {
 public:
  /// Throws IoError or ConfigError where recording or front-end are not there.
  EventSource(const ReplayOptions& options, const FrontendSettings& settings,
              const std::atomic<bool>& interrupt);

  /// The events up to and including the next frame (or a good many without one, or a note); nothing
  /// after the last. An interrupt ends the recording: what the front-end still has comes with the
  /// last batch.
  std::optional<EventBatch> next();

  /// What follows is for after the end.
  RunEnd runEnd() const;
  UnusedCounts unused() const;
  const Findings& findings() const { return findings_; }
  double recordingSeconds() const;
  const std::vector<StageTimes>& stages() const { return stopwatch_.stages(); }

 private:
  bool wanted(const mrpt::obs::CObservation& observation);
  bool feedOne();
  void drainInto(EventBatch& batch);
  void finish(EventBatch& batch);

  const ReplayOptions& options_;
  const std::atomic<bool>& interrupt_;
  RawlogStream log_;
  OdometryFrontend::Ptr frontend_;
  DataChecks checks_;
  Findings findings_;  // without notes: the front-end has its own
  StageStopwatch stopwatch_;
  std::optional<TimeNs> first_ns_;
  TimeNs last_ns_ = 0;
  bool past_end_ = false, ended_ = false, interrupted_ = false;
  std::uint64_t read_ = 0, outside_span_ = 0;  // observations
};

/// Runs a source some scans ahead in a thread of its own.
class ReadAhead {
 public:
  explicit ReadAhead(EventSource& source);
  ~ReadAhead();
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  /// As EventSource::next(), also in what it throws. Once it has returned nothing, the source is
  /// free for use by the caller.
  std::optional<EventBatch> next();

 private:
  void run();

  EventSource& source_;
  BoundedQueue<EventBatch> queue_;
  std::thread thread_;
};

}  // namespace paloc
