#include <algorithm>
#include <optional>

#include "data_check.h"
#include "paloc/core/text.h"
#include "sentence_parts.h"

namespace paloc {
namespace {

constexpr double kShare = 0.05;  // at rest a coarse IMU repeats itself now and then
constexpr std::uint64_t kFewest = 100;

class RepeatedCheck : public DataCheck {
 public:
  explicit RepeatedCheck(const CheckedStream& stream) : stream_(stream) {}

  void addImu(const ImuSample& sample) override {
    ++samples_;
    const bool later = last_ && sample.t_ns > last_->t_ns;
    if (later && sample.acc_body == last_->acc_body && sample.omega_body == last_->omega_body &&
        repeats_++ == 0) {
      first_ns_ = sample.t_ns;
    }
    last_ = sample;
  }

  void report(Findings& findings) const override {
    const double share =
        static_cast<double>(repeats_) / static_cast<double>(std::max<std::uint64_t>(1, samples_));
    if (samples_ < kFewest || share < kShare) return;
    Finding finding = stream_.finding("repeated-values", Severity::kWarning);
    finding.value = share;
    finding.t_ns = first_ns_;
    finding.sentence = text(figure("%.0f", 100 * share), " % of the samples of ", stream_.name(),
                            " have the very values of the sample before: they were held to reach a "
                            "higher rate, or the sensor froze; record it at its own rate");
    findings.push_back(finding);
  }

 private:
  CheckedStream stream_;
  std::optional<ImuSample> last_;
  std::uint64_t samples_ = 0, repeats_ = 0;
  TimeNs first_ns_ = 0;
};

}  // namespace

DataCheckPtr makeRepeatedCheck(const CheckedStream& stream) {
  return std::make_unique<RepeatedCheck>(stream);
}

}  // namespace paloc
