#include "data_check.h"
#include "log_histogram.h"
#include "paloc/core/text.h"
#include "sentence_parts.h"

namespace paloc {
namespace {

constexpr double kGravity = 9.81;  // m/s2
constexpr std::uint64_t kFewest = 20;

// Half of the time even a runner's acceleration has about the size of gravity, so the median of the
// norm tells the unit; a scale error or the bias of a cheap sensor makes less than this.
constexpr double kTolerance = 0.12;

class AccelerationCheck : public DataCheck {
 public:
  explicit AccelerationCheck(const CheckedStream& stream) : stream_(stream) {}

  void addImu(const ImuSample& sample) override {
    norms_.add(sample.acc_body.norm());
    sum_ += sample.acc_body;
    sum_of_norms_ += sample.acc_body.norm();
  }

  void report(Findings& findings) const override {
    const double median = norms_.quantile(0.5);
    if (norms_.count() < kFewest || isNear(median, kGravity)) return;
    Finding finding = stream_.finding("acceleration-unit", Severity::kError);
    finding.value = median;
    finding.unit = "m/s2";
    finding.sentence = sentence(median);
    findings.push_back(finding);
  }

 private:
  static bool isNear(double value, double expected) {
    return std::abs(value / expected - 1) < kTolerance;
  }

  std::string sentence(double median) const {
    const std::string reads =
        text("the accelerometer of ", stream_.name(), " reads ", figure("%.3g", median),
             " where gravity alone makes 9.81 m/s2: ");
    if (sum_.norm() > 0.5 * sum_of_norms_) {  // gravity is in it: it points one way
      if (isNear(median, 1)) return reads + "it is in g; multiply it by 9.80665 before the import";
      if (isNear(median, 990)) {  // 1000 or 981: too near to each other
        return reads +
               "it is in thousandths of g or in cm/s2, see its manual; convert it to m/s2 before "
               "the import";
      }
      return reads + "its unit or scale is wrong; convert it to m/s2 before the import";
    }
    if (median < 0.5 * kGravity) {
      return reads +
             "gravity has been taken out; record the specific force as the sensor measures it";
    }
    return reads + "its unit or scale is wrong, or it is shaken hard; see what it reads at rest";
  }

  CheckedStream stream_;
  LogHistogram norms_;
  Vec3 sum_ = Vec3::Zero();
  double sum_of_norms_ = 0;
};

}  // namespace

DataCheckPtr makeAccelerationCheck(const CheckedStream& stream) {
  return std::make_unique<AccelerationCheck>(stream);
}

}  // namespace paloc
