#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "paloc/frontends/data_checks.h"
#include "recorded_walk.h"

/// Recordings for the checks of the data, and what they find in them.
namespace paloc::test::checked {

using recorded::CObservation;
using recorded::kMs;
using recorded::kT0;
using Observations = std::vector<CObservation::Ptr>;

struct Checked {
  Findings findings;
  std::vector<MotionComparison> motions;

  /// The first finding of a check, notes included; nullptr if there is none.
  const Finding* find(const std::string& check) const {
    const auto found = std::find_if(findings.begin(), findings.end(),
                                    [&](const Finding& f) { return f.check == check; });
    return found == findings.end() ? nullptr : &*found;
  }
  /// Names of the checks that found something wrong, in order.
  std::string wrong() const {
    std::string names;
    for (const Finding& finding : findings) {
      if (finding.severity == Severity::kNote) continue;
      names += (names.empty() ? "" : " ") + finding.check;
    }
    return names;
  }
  std::string sentence(const std::string& check) const {
    const Finding* finding = find(check);
    return finding ? finding->sentence : "";
  }
};

inline Checked check(const Observations& observations, const FrontendSettings& settings = {},
                     DataChecks::Extent extent = DataChecks::Extent::kFull) {
  DataChecks checks(settings, extent);
  for (const auto& observation : observations) checks.add(*observation);
  checks.finish();
  return {checks.findings(), checks.motions()};
}

/// IMU samples, as the body of recorded_walk.h sways.
inline Observations imuStream(int samples, TimeNs step = 5 * kMs) {
  Observations all;
  for (int i = 0; i < samples; ++i) all.push_back(recorded::imuAt(kT0 + i * step));
  return all;
}

inline Observations odometryStream(int poses, TimeNs step = 100 * kMs) {
  Observations all;
  for (int i = 0; i < poses; ++i) all.push_back(recorded::poseAt(kT0 + i * step));
  return all;
}

inline recorded::CObservationIMU& imuOf(const CObservation::Ptr& observation) {
  return dynamic_cast<recorded::CObservationIMU&>(*observation);
}

/// Several streams as one, in the order of their stamps.
inline Observations merged(const std::vector<Observations>& streams) {
  Observations all;
  for (const Observations& stream : streams) all.insert(all.end(), stream.begin(), stream.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a->timestamp < b->timestamp; });
  return all;
}

}  // namespace paloc::test::checked
