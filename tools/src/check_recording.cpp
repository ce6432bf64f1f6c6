#include "paloc/tools/check_recording.h"

#include <mrpt/obs/CObservation.h>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"
#include "paloc/frontends/data_checks.h"
#include "paloc/frontends/map_scale_check.h"
#include "paloc/frontends/mrpt_time.h"
#include "paloc/frontends/rawlog_stream.h"
#include "paloc/map/cloud_io.h"

namespace paloc {

RecordingCheck checkRecording(const std::filesystem::path& file, const std::filesystem::path& map,
                              const FrontendSettings& settings,
                              const std::function<void(double share)>& progress) {
  RawlogStream stream(file);
  DataChecks checks(settings, DataChecks::Extent::kFull);
  RecordingCheck result;
  result.file = file.string();
  while (const auto observation = stream.next()) {
    if (result.observations++ == 0) result.first_ns = fromMrptTime(observation->timestamp);
    checks.add(*observation);
    if (progress) progress(stream.progress());
  }
  if (result.observations == 0) {
    throw IoError(stream.error().empty() ? text(file.string(), ": holds no observation")
                                         : stream.error());
  }
  checks.finish();
  result.damage = stream.error();
  result.motions = checks.motions();
  Findings findings = checks.findings();
  if (!map.empty()) {
    const Findings of_map =
        checkMapScale(loadCloud(map), map.filename().string(), checks.scanReach());
    findings.insert(findings.end(), of_map.begin(), of_map.end());
  }
  for (const Finding& finding : findings) {
    (finding.severity == Severity::kNote ? result.notes : result.findings).push_back(finding);
  }
  return result;
}

}  // namespace paloc
