#include <algorithm>
#include <array>
#include <cmath>

#include "data_check.h"
#include "paloc/core/text.h"
#include "sentence_parts.h"

namespace paloc {
namespace {

/// One side of one axis: how often, and how, its greatest value comes.
class Extreme {
 public:
  void add(double value, TimeNs t_ns) {
    const double step = std::abs(value - last_);
    if (step > 0) bit_ = std::min(bit_, step);
    last_ = value;
    least_ = std::min(least_, value);
    if (value > greatest_) rise(value, t_ns);
    run_ = value == greatest_ ? run_ + 1 : 0;
    if (value == greatest_) {
      ++times_;
    } else if (value > greatest_ - band()) {
      ++near_;
    }
    if (run_ == 2 && secondsBetween(last_run_ns_, t_ns) > kApart) {
      ++runs_;
      last_run_ns_ = t_ns;
    }
  }

  /// A signal that is cut off comes to the same greatest value again and again and stays there,
  /// while it passes quickly through the values below. A peak of a coarse signal dwells there too.
  bool isClipped(double range) const {
    return runs_ >= 2 && times_ >= 10 && times_ > 3 * near_ && greatest_ > 0.2 * range;
  }
  double greatest() const { return greatest_; }
  std::uint64_t times() const { return times_; }
  TimeNs firstNs() const { return first_ns_; }

 private:
  static constexpr double kApart = 0.2;  // s: another swing of the signal

  // Of the swing, not of the value: gravity is no part of it.
  double band() const { return std::max(0.02 * (greatest_ - least_), 3.5 * bit_); }

  void rise(double value, TimeNs t_ns) {
    const bool still_near = value - greatest_ < band();
    near_ = still_near ? near_ + times_ : 0;
    greatest_ = value;
    first_ns_ = t_ns;
    last_run_ns_ = INT64_MIN / 2;
    times_ = 0;
    run_ = runs_ = 0;
  }

  double greatest_ = -INFINITY, least_ = INFINITY, last_ = NAN;
  double bit_ = INFINITY;  // the smallest step seen: how coarse the signal is
  TimeNs first_ns_ = 0, last_run_ns_ = INT64_MIN / 2;
  std::uint64_t times_ = 0, near_ = 0;  // at the greatest value, just below
  int run_ = 0, runs_ = 0;              // samples in a row at it; such runs
};

class SaturationCheck : public DataCheck {
 public:
  explicit SaturationCheck(const CheckedStream& stream) : stream_(stream) {}

  void addImu(const ImuSample& sample) override {
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      add(acc_[i], sample.acc_body[axis], sample.t_ns);
      add(gyro_[i], sample.omega_body[axis], sample.t_ns);
    }
  }

  void report(Findings& findings) const override {
    // Less than this over a recording is a sensor at rest, whose least bit may well repeat.
    constexpr double kStillAcc = 1.0, kStillGyro = 0.1;  // m/s2, rad/s
    report(acc_, "accelerometer", "m/s2", kStillAcc, findings);
    report(gyro_, "gyroscope", "rad/s", kStillGyro, findings);
  }

 private:
  struct Axis {
    Extreme high, low;
    double range() const { return high.greatest() + low.greatest(); }
  };
  using Axes = std::array<Axis, 3>;

  static void add(Axis& axis, double value, TimeNs t_ns) {
    axis.high.add(value, t_ns);
    axis.low.add(-value, t_ns);
  }

  void report(const Axes& axes, const char* sensor, const char* unit, double still,
              Findings& findings) const {
    const Extreme* worst = nullptr;
    std::string names;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      bool clipped = false;
      for (const Extreme* extreme : {&axes[i].high, &axes[i].low}) {
        if (axes[i].range() < still || !extreme->isClipped(axes[i].range())) continue;
        clipped = true;
        if (!worst || extreme->times() > worst->times()) worst = extreme;
      }
      if (clipped) names += text(names.empty() ? "" : ", ", "xyz"[i]);
    }
    if (!worst) return;
    Finding finding = stream_.finding("saturation", Severity::kError);
    finding.value = worst->greatest();
    finding.unit = unit;
    finding.t_ns = worst->firstNs();
    finding.sentence =
        text("the ", sensor, " of ", stream_.name(), " (", names, ") is clipped at ",
             figure("%.4g", worst->greatest()), ' ', unit, " (reached in ", worst->times(),
             " samples): set it to a wider range, or move less violently");
    findings.push_back(finding);
  }

  CheckedStream stream_;
  Axes acc_, gyro_;
};

}  // namespace

DataCheckPtr makeSaturationCheck(const CheckedStream& stream) {
  return std::make_unique<SaturationCheck>(stream);
}

}  // namespace paloc
