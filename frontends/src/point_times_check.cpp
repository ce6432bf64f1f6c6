#include <algorithm>
#include <optional>
#include <set>

#include "data_check.h"
#include "log_histogram.h"
#include "paloc/core/text.h"
#include "sentence_parts.h"

namespace paloc {
namespace {

class PointTimesCheck : public DataCheck {
 public:
  explicit PointTimesCheck(const CheckedStream& stream) : stream_(stream) {}

  void addStamp(TimeNs t_ns) override {
    if (last_ && t_ns > *last_) periods_.add(secondsBetween(*last_, t_ns));
    last_ = t_ns;
  }

  void addScan(const LidarFrame& frame) override {
    constexpr std::size_t kMostPolicies = 5;
    if (policies_.size() < kMostPolicies) policies_.insert(frame.time_policy);
    if (frame.deskewed || frame.points_lidar.empty()) return;
    ++scans_;
    if (frame.dt_ns.empty()) {
      ++without_;
      return;
    }
    const auto [first, last] = std::minmax_element(frame.dt_ns.begin(), frame.dt_ns.end());
    firsts_.add(1e-9 * *first);
    lasts_.add(1e-9 * *last);
    spans_.add(1e-9 * (*last - *first));
  }

  void report(Findings& findings) const override {
    reportPolicies(findings);
    if (scans_ == 0 || periods_.count() == 0) return;
    if (without_ == scans_) return reportWithout(findings);
    const Times usual = {periods_.quantile(0.5), spans_.quantile(0.5), firsts_.quantile(0.5),
                         lasts_.quantile(0.5)};
    Finding finding = stream_.finding("point-times", Severity::kError);
    finding.unit = "s";
    finding.value = usual.span_s;
    const std::string wrong = whatIsWrong(usual);
    if (wrong.empty()) return;
    finding.sentence = text("the point times of ", stream_.name(), ' ', wrong);
    findings.push_back(finding);
  }

 private:
  /// Of a usual scan: time to the next, from first to last point, and these after the stamp (s).
  struct Times {
    double period_s = 0, span_s = 0, first_s = 0, last_s = 0;
  };

  // The rest of a sentence; empty if nothing is.
  static std::string whatIsWrong(const Times& t) {
    constexpr double kWrap = 4.294967296;  // s: a negative time in 32 unsigned bits of ns
    if (t.last_s > 4.0 && t.last_s > 3 * t.period_s && t.last_s - kWrap > -2 * t.period_s) {
      return "are negative, wrapped round to 4.29 s: they count back from the scan's end; import "
             "them as such (import clouds --time-reference end)";
    }
    if (t.span_s <= 1e-7) {
      return text("are all the same (", figure("%.3g", t.first_s < 1e-6 ? 0 : t.first_s),
                  " s): scans cannot be deskewed by them; import the sensor's times, or say that "
                  "the scans are deskewed (import clouds --deskewed)");
    }
    if (t.last_s > 1.5 * t.period_s) {
      return text("reach ", figure("%.3g", t.last_s),
                  " s after the stamp, where a scan comes every ", figure("%.3g", t.period_s),
                  " s: ", remedy(t.period_s / t.last_s));
    }
    if (t.span_s < 0.02 * t.period_s) {
      return text("span only ", figure("%.3g", t.span_s), " s in a scan every ",
                  figure("%.3g", t.period_s), " s: ", remedy(t.period_s / t.span_s));
    }
    return {};
  }

  // Units lie thousands apart, and a scan takes a tenth of its period at least.
  static std::string remedy(double period_over_span) {
    for (const double factor : {1e9, 1e6, 1e3, 1e-3, 1e-6, 1e-9}) {
      const double ratio = period_over_span / factor;
      if (ratio < 0.7 || ratio > 12) continue;
      return text("their unit was taken wrongly, by a factor of ", figure("%g", factor),
                  "; import them with the right one (import clouds --time-unit)");
    }
    return "they do not fit the scan's period; look at their unit and what they count from";
  }

  // How they are read is told, too: a wrong guess costs as much as a wrong time.
  void reportPolicies(Findings& findings) const {
    for (const std::string& policy : policies_) {
      if (policy.empty()) continue;
      Finding finding = stream_.finding("point-times", Severity::kNote);
      finding.sentence = text("scans of ", stream_.name(), ": ", policy);
      findings.push_back(finding);
    }
  }

  void reportWithout(Findings& findings) const {
    Finding finding = stream_.finding("point-times", Severity::kNote);
    finding.sentence = text("the points of ", stream_.name(),
                            " have no times: its scans are used as if taken at one instant, unless "
                            "they say that they are deskewed");
    findings.push_back(finding);
  }

  CheckedStream stream_;
  std::optional<TimeNs> last_;
  std::uint64_t scans_ = 0, without_ = 0;
  std::set<std::string> policies_;  // how the decoder read the times
  LogHistogram periods_, firsts_, lasts_, spans_;
};

}  // namespace

DataCheckPtr makePointTimesCheck(const CheckedStream& stream) {
  return std::make_unique<PointTimesCheck>(stream);
}

}  // namespace paloc
