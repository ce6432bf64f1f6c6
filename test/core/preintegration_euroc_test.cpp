#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "euroc_data.h"
#include "paloc/core/imu_factor.h"
#include "paloc/core/imu_sample.h"
#include "shared_data.h"

namespace paloc {
namespace {

ImuSample at(const std::vector<ImuSample>& samples, std::size_t after, TimeNs t_ns) {
  const ImuSample &a = samples[after - 1], &b = samples[after];
  const double ratio = secondsBetween(a.t_ns, t_ns) / secondsBetween(a.t_ns, b.t_ns);
  return {t_ns, a.acc_body + ratio * (b.acc_body - a.acc_body),
          a.omega_body + ratio * (b.omega_body - a.omega_body)};
}

// Trapezoids: between two samples, and from and to interpolated ones at the ends.
Preintegration integrate(const std::vector<ImuSample>& samples, const State& start, TimeNs from_ns,
                         TimeNs to_ns) {
  Preintegration p(ImuNoise(), start.bias_acc, start.bias_gyro);
  auto next = std::upper_bound(samples.begin(), samples.end(), from_ns,
                               [](TimeNs t, const ImuSample& s) { return t < s.t_ns; });
  ImuSample here = at(samples, static_cast<std::size_t>(next - samples.begin()), from_ns);
  while (here.t_ns < to_ns) {
    const ImuSample there =
        next->t_ns <= to_ns ? *next
                            : at(samples, static_cast<std::size_t>(next - samples.begin()), to_ns);
    p.integrate(0.5 * (here.acc_body + there.acc_body), 0.5 * (here.omega_body + there.omega_body),
                secondsBetween(here.t_ns, there.t_ns));
    here = there;
    ++next;
  }
  return p;
}

// Median error of the position predicted from the true state, `rows_ahead` rows of truth (5 ms).
double medianPositionError(const std::vector<ImuSample>& samples,
                           const std::vector<EurocTruth>& truth, std::size_t rows_ahead) {
  std::vector<double> errors;
  for (std::size_t k = 0; k + rows_ahead < truth.size(); k += 20) {
    const EurocTruth &from = truth[k], &to = truth[k + rows_ahead];
    if (from.t_ns < samples.front().t_ns || to.t_ns >= samples.back().t_ns) continue;
    const ImuFactor factor(integrate(samples, from.state, from.t_ns, to.t_ns), 9.81);
    const Vec3 predicted = factor.predict(from.state).T_map_body.position;
    errors.push_back((predicted - to.state.T_map_body.position).norm());
  }
  std::nth_element(errors.begin(), errors.begin() + static_cast<long>(errors.size() / 2),
                   errors.end());
  return errors.at(errors.size() / 2);
}

TEST(PreintegrationOnEuroc, PredictsFromTheTrueState) {
  const std::filesystem::path folder = sharedData() / "imu";
  const std::vector<ImuSample> samples = readEurocImu(folder / "euroc_mh05_imu0.txt");
  const std::vector<EurocTruth> truth = readEurocTruth(folder / "euroc_mh05_groundtruth.csv");
  if (samples.empty() || truth.empty()) GTEST_SKIP() << "no EuRoC data in " << folder;
  const double short_error_m = medianPositionError(samples, truth, 20);
  const double long_error_m = medianPositionError(samples, truth, 100);
  RecordProperty("median_after_0.1_s_mm", std::to_string(1e3 * short_error_m));
  RecordProperty("median_after_0.5_s_mm", std::to_string(1e3 * long_error_m));
  std::cout << "median position error after 0.1 s " << 1e3 * short_error_m << " mm, after 0.5 s "
            << 1e3 * long_error_m << " mm\n";
  EXPECT_LE(short_error_m, 0.5e-3);
  EXPECT_LE(long_error_m, 9e-3);
}

}  // namespace
}  // namespace paloc
