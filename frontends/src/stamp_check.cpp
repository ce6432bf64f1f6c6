#include <algorithm>
#include <optional>

#include "data_check.h"
#include "paloc/core/text.h"
#include "sentence_parts.h"

namespace paloc {
namespace {

class StampCheck : public DataCheck {
 public:
  explicit StampCheck(const CheckedStream& stream) : stream_(stream) {}

  void addStamp(TimeNs t_ns) override {
    if (last_ && t_ns == *last_ && repeats_++ == 0) first_repeat_ns_ = t_ns;
    if (last_ && t_ns < *last_) {
      if (rewinds_++ == 0) first_rewind_ns_ = *last_;
      furthest_s_ = std::max(furthest_s_, secondsBetween(t_ns, *last_));
    }
    last_ = t_ns;
  }

  void report(Findings& findings) const override {
    if (rewinds_ > 0) {
      Finding finding = stream_.finding("rewind", Severity::kError);
      finding.value = furthest_s_;
      finding.unit = "s";
      finding.t_ns = first_rewind_ns_;
      finding.sentence = text(
          "time goes backwards in ", stream_.name(), ' ', timesText(rewinds_), ", by at most ",
          figure("%.4g", furthest_s_), " s: what comes again is not used; sort the recording by ",
          "stamp, or, where the clock was set while it ran, cut it there (--from, --to)");
      findings.push_back(finding);
    }
    if (repeats_ > 0) {
      Finding finding = stream_.finding("duplicates", Severity::kWarning);
      finding.value = static_cast<double>(repeats_);
      finding.t_ns = first_repeat_ns_;
      finding.sentence =
          text(stream_.name(), " repeats the stamp before ", timesText(repeats_),
               ": the repetitions are not used; look for two recorders or drivers of "
               "the same sensor, and write each observation once");
      findings.push_back(finding);
    }
  }

 private:
  CheckedStream stream_;
  std::optional<TimeNs> last_;
  TimeNs first_rewind_ns_ = 0, first_repeat_ns_ = 0;
  std::uint64_t rewinds_ = 0, repeats_ = 0;
  double furthest_s_ = 0;
};

}  // namespace

DataCheckPtr makeStampCheck(const CheckedStream& stream) {
  return std::make_unique<StampCheck>(stream);
}

}  // namespace paloc
