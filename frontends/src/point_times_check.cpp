#include <algorithm>
#include <optional>

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
    if (scans_ == 0 || periods_.count() == 0) return;
    if (without_ == scans_) return reportWithout(findings);
    const double period_s = periods_.quantile(0.5), span_s = spans_.quantile(0.5),
                 first_s = firsts_.quantile(0.5), last_s = lasts_.quantile(0.5);
    Finding finding = stream_.finding("point-times", Severity::kError);
    finding.unit = "s";
    finding.value = span_s;
    const std::string named = text("the point times of ", stream_.name());
    const std::string spans =
        text(figure("%.3g", span_s), " s in a scan every ", figure("%.3g", period_s), " s");
    // As unsigned 32 bits a negative time is about 4.29 s.
    if (last_s > 4.0 && last_s > 3 * period_s && last_s - 4.294967296 > -2 * period_s) {
      finding.value = last_s - 4.294967296;
      finding.sentence = named +
                         " are negative, wrapped round to 4.29 s: they count back from the scan's "
                         "end; import them as such (import clouds --time-reference end)";
    } else if (span_s <= 1e-7) {
      finding.sentence =
          text(named, " are all the same (", figure("%.3g", first_s),
               " s): scans cannot be deskewed by them; import the sensor's times, or "
               "say that the scans are deskewed (import clouds --deskewed)");
    } else if (last_s > 1.5 * period_s) {
      finding.value = last_s;
      finding.sentence = text(named, " reach ", figure("%.3g", last_s),
                              " s after the stamp, where a scan comes every ",
                              figure("%.3g", period_s), " s: ", remedy(period_s / last_s));
    } else if (span_s < 0.02 * period_s) {
      finding.sentence = text(named, " span only ", spans, ": ", remedy(period_s / span_s));
    } else {
      return;
    }
    findings.push_back(finding);
  }

 private:
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
  LogHistogram periods_, firsts_, lasts_, spans_;
};

}  // namespace

DataCheckPtr makePointTimesCheck(const CheckedStream& stream) {
  return std::make_unique<PointTimesCheck>(stream);
}

}  // namespace paloc
