#include "paloc/tools/event_source.h"

#include <algorithm>

#include "paloc/core/text.h"
#include "paloc/frontends/mrpt_time.h"

namespace paloc {
namespace {

constexpr std::size_t kBatchesAhead = 8;     // a scan each: some 2 MB
constexpr std::size_t kMostEvents = 10'000;  // in a batch, where no scan comes

}  // namespace

EventSource::EventSource(const ReplayOptions& options, const FrontendSettings& settings,
                         const std::atomic<bool>& interrupt)
    : options_(options),
      interrupt_(interrupt),
      log_(options.log_file),
      frontend_(OdometryFrontend::create(options.frontend, settings)),
      checks_(settings, DataChecks::Extent::kCheap) {}

bool EventSource::wanted(const mrpt::obs::CObservation& observation) {
  const TimeNs t_ns = fromMrptTime(observation.timestamp);
  if (!first_ns_) first_ns_ = t_ns;
  const double since_start = secondsBetween(*first_ns_, t_ns);
  past_end_ = options_.to_s && since_start > *options_.to_s;
  if (since_start < options_.from_s || past_end_) {
    ++outside_span_;
    return false;
  }
  last_ns_ = std::max(last_ns_, t_ns);
  return true;
}

// Gives one observation to the front-end; false when there are no more.
bool EventSource::feedOne() {
  if (past_end_) return false;
  interrupted_ = interrupt_;
  if (interrupted_) return false;
  mrpt::obs::CObservation::Ptr observation;
  {
    StageScope stage(&stopwatch_, "read");
    observation = log_.next();
  }
  if (!observation) return false;
  ++read_;
  if (!wanted(*observation)) return true;
  {
    StageScope stage(&stopwatch_, "frontend");
    frontend_->add(*observation);
  }
  StageScope stage(&stopwatch_, "checks");
  checks_.add(*observation);
  return true;
}

void EventSource::finish(EventBatch& batch) {
  {
    StageScope stage(&stopwatch_, "frontend");
    frontend_->finish();
  }
  StageScope stage(&stopwatch_, "checks");
  checks_.finish();
  for (const Finding& finding : checks_.findings()) {
    if (finding.severity == Severity::kNote) continue;
    findings_.push_back(finding);
    batch.notes.push_back(finding.sentence);
  }
}

void EventSource::drainInto(EventBatch& batch) {
  StageScope stage(&stopwatch_, "frontend");
  while (std::optional<FrontendEvent> event = frontend_->next()) {
    batch.frames += std::holds_alternative<OdometryFrame>(*event);
    batch.events.push_back(std::move(*event));
  }
}

std::optional<EventBatch> EventSource::next() {
  EventBatch batch;
  while (!ended_ && batch.frames == 0 && batch.notes.empty() && batch.events.size() < kMostEvents) {
    ended_ = !feedOne();
    if (ended_) finish(batch);
    drainInto(batch);
    const std::vector<std::string> notes = frontend_->takeNotes();
    batch.notes.insert(batch.notes.begin(), notes.begin(), notes.end());
  }
  if (batch.events.empty() && batch.notes.empty()) return {};
  batch.share = log_.progress();
  if (first_ns_) batch.recording_s = secondsBetween(*first_ns_, last_ns_);
  return batch;
}

UnusedCounts EventSource::unused() const {
  UnusedCounts unused = frontend_->unused();
  unused.add("observations", "all", "outside --from and --to", outside_span_);
  return unused;
}

RunEnd EventSource::runEnd() const {
  RunEnd end;
  end.interrupted = interrupted_;
  if (log_.end() == RawlogStream::End::kDamaged) end.damage = log_.error();
  if (end.interrupted) return end;  // more may have come
  if (read_ == 0) {
    if (end.damage.empty())
      end.problems.push_back(options_.log_file.string() + ": holds no observation");
  } else if (read_ == outside_span_) {
    end.problems.push_back(text("--from and --to leave nothing of the recording: all of ", read_,
                                " observations lie outside"));
  } else {
    end.problems = frontend_->problems();
  }
  return end;
}

double EventSource::recordingSeconds() const {
  return read_ > outside_span_ ? secondsBetween(*first_ns_, last_ns_) - options_.from_s : 0;
}

ReadAhead::ReadAhead(EventSource& source)
    : source_(source), queue_(kBatchesAhead), thread_([this] { run(); }) {}

ReadAhead::~ReadAhead() {
  queue_.abandon();
  if (thread_.joinable()) thread_.join();
}

void ReadAhead::run() {
  try {
    while (std::optional<EventBatch> batch = source_.next()) {
      if (!queue_.push(std::move(*batch))) break;
    }
    queue_.end();
  } catch (...) {
    queue_.end(std::current_exception());
  }
}

std::optional<EventBatch> ReadAhead::next() {
  std::optional<EventBatch> batch = queue_.pop();
  if (!batch && thread_.joinable()) thread_.join();
  return batch;
}

}  // namespace paloc
