#include <algorithm>
#include <cmath>
#include <optional>

#include "data_check.h"
#include "log_histogram.h"
#include "paloc/core/text.h"
#include "sentence_parts.h"

namespace paloc {
namespace {

constexpr std::uint64_t kFewestSteps = 10;

// Below this the stream is of little use (Hz). An IMU: walking swings at 2 Hz and shakes up to 15.
double lowestRate(StreamKind kind) {
  switch (kind) {
    case StreamKind::kImu:
      return 50;
    case StreamKind::kLidar:
      return 4;
    case StreamKind::kOdometry:
      return 2;
  }
  return 0;
}

class RateCheck : public DataCheck {
 public:
  RateCheck(const CheckedStream& stream, const FrontendSettings& settings)
      : stream_(stream), settings_(settings) {}

  void addStamp(TimeNs t_ns) override {
    if (last_ && t_ns > *last_) {
      const double step_s = secondsBetween(*last_, t_ns);
      steps_.add(step_s);
      span_s_ += step_s;
      if (step_s > longest_s_) {
        longest_s_ = step_s;
        longest_ns_ = *last_;
      }
    }
    last_ = t_ns;
  }

  void report(Findings& findings) const override {
    if (steps_.count() < kFewestSteps) return;
    reportGaps(findings);
    reportRate(findings);
    reportEvenness(findings);
  }

 private:
  // A step longer than this is a gap: the front-end does not bridge it, or a scan is missing.
  double longestStep() const {
    const double usual = steps_.quantile(0.5);
    switch (stream_.kind) {
      case StreamKind::kImu:
        return std::max(settings_.max_imu_gap_s, 3 * usual);
      case StreamKind::kLidar:
        return 1.7 * usual;
      case StreamKind::kOdometry:
        return std::max(settings_.max_odometry_gap_s, 3 * usual);
    }
    return 0;
  }

  void reportGaps(Findings& findings) const {
    const double limit_s = longestStep();
    if (longest_s_ <= limit_s) return;
    const std::uint64_t gaps = std::max<std::uint64_t>(1, steps_.countAbove(limit_s));
    Finding finding = stream_.finding("gaps", Severity::kWarning);
    finding.value = longest_s_;
    finding.unit = "s";
    finding.t_ns = longest_ns_;
    finding.sentence = text(stream_.name(), " pauses for more than ", figure("%.3g", limit_s),
                            " s ", timesText(gaps), ", at most for ", figure("%.3f", longest_s_),
                            " s: look whether the recorder or the network dropped data; the "
                            "trajectory has to bridge it without this sensor");
    findings.push_back(finding);
  }

  void reportRate(Findings& findings) const {
    // Without the gaps: those are told apart.
    const double usual_s =
        std::min(span_s_ / static_cast<double>(steps_.count()), steps_.quantile(0.9));
    const double rate_hz = 1 / usual_s, lowest_hz = lowestRate(stream_.kind);
    if (rate_hz >= lowest_hz) return;
    Finding finding = stream_.finding("rate", Severity::kWarning);
    finding.value = rate_hz;
    finding.unit = "Hz";
    finding.sentence =
        text(stream_.name(), " comes at ", figure("%.3g", rate_hz), " Hz, which is less than the ",
             figure("%g", lowest_hz),
             " Hz that the motion needs: set the sensor to a higher rate, and record "
             "all that it gives");
    findings.push_back(finding);
  }

  void reportEvenness(Findings& findings) const {
    if (stream_.kind == StreamKind::kOdometry) return;  // some come when they are ready
    // Twice or three times the usual step is a sample that is missing: a gap, not unevenness.
    const double usual = steps_.quantile(0.5), longest = longestStep();
    double off_s = 0, all_s = 0;
    steps_.each([&](double step, std::uint64_t count) {
      if (step > longest) return;
      const double time_s = step * static_cast<double>(count), times = step / usual;
      const double whole = std::clamp(std::round(times), 1.0, 5.0);
      all_s += time_s;
      if (std::abs(times - whole) > 0.3) off_s += time_s;
    });
    const double share = off_s / all_s;
    if (share < 0.1) return;
    Finding finding = stream_.finding("uneven", Severity::kWarning);
    finding.value = share;
    finding.sentence =
        text(stream_.name(), " has uneven stamps (", figure("%.0f", 100 * share),
             " % of the time is in steps that are no multiple of the usual ",
             figure("%.3g", 1e3 * usual),
             " ms): they seem to tell when data arrived; use the sensor's own clock");
    findings.push_back(finding);
  }

  CheckedStream stream_;
  FrontendSettings settings_;
  std::optional<TimeNs> last_;
  LogHistogram steps_;
  double span_s_ = 0, longest_s_ = 0;
  TimeNs longest_ns_ = 0;
};

}  // namespace

DataCheckPtr makeRateCheck(const CheckedStream& stream, const FrontendSettings& settings) {
  return std::make_unique<RateCheck>(stream, settings);
}

}  // namespace paloc
