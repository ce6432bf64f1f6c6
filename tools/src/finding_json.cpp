#include "paloc/tools/finding_json.h"

namespace paloc {
namespace {

using Json = nlohmann::ordered_json;

Json jsonOfOne(const Finding& finding) {
  Json json = {{"check", finding.check},
               {"severity", severityName(finding.severity)},
               {"label", finding.label}};
  json["value"] = finding.value ? Json(*finding.value) : Json();
  json["unit"] = finding.unit;
  json["t_s"] = finding.t_ns ? Json(1e-9 * static_cast<double>(*finding.t_ns)) : Json();
  json["sentence"] = finding.sentence;
  return json;
}

}  // namespace

const char* severityName(Severity severity) {
  switch (severity) {
    case Severity::kNote:
      return "note";
    case Severity::kWarning:
      return "warning";
    case Severity::kError:
      return "error";
  }
  return "";
}

nlohmann::ordered_json jsonOf(const Findings& findings) {
  Json json = Json::array();
  for (const Finding& finding : findings) json.push_back(jsonOfOne(finding));
  return json;
}

}  // namespace paloc
