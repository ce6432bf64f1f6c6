#include <cstdio>
#include <nlohmann/json.hpp>

#include "paloc/tools/bench_registration.h"

namespace paloc {
namespace {

using Json = nlohmann::ordered_json;

Json jsonOf(const ScanQuantiles& q) { return {{"p50", q.p50}, {"p95", q.p95}, {"p99", q.p99}}; }

Json jsonOf(const RegistrationRun& r) {
  Json json;
  json["map_points"] = r.map_points;
  json["threads"] = r.threads;
  json["match_ms"] = jsonOf(r.match_ms);
  json["cpu_ms"] = jsonOf(r.cpu_ms);
  json["filter_ms"] = jsonOf(r.filter_ms);
  json["association_ms"] = jsonOf(r.association_ms);
  json["solve_ms"] = jsonOf(r.solve_ms);
  json["information_ms"] = jsonOf(r.information_ms);
  json["pose_ms"] = jsonOf(r.pose_ms);
  json["spectrum_ms"] = jsonOf(r.spectrum_ms);
  json["error_m"] = jsonOf(r.error_m);
  json["error_rad"] = jsonOf(r.error_rad);
  json["scans"] = r.scans;
  json["accepted"] = r.accepted;
  json["points_in"] = r.points_in;
  json["points_used"] = r.points_used;
  json["matched"] = r.matched;
  json["iterations"] = r.iterations;
  json["load_s"] = r.load_s;
  json["sort_s"] = r.sort_s;
  json["index_s"] = r.index_s;
  json["planes_s"] = r.planes_s;
  json["planar"] = r.planar;
  json["bytes_a_point"] = r.bytes_a_point;
  return json;
}

template <typename... Values>
void append(std::string& out, const char* format, Values... values) {
  char line[240];
  std::snprintf(line, sizeof line, format, values...);
  out += line;
}

void appendQuantiles(std::string& out, const char* name, const ScanQuantiles& q, double unit) {
  append(out, "  %-22s %9.3f %9.3f %9.3f\n", name, unit * q.p50, unit * q.p95, unit * q.p99);
}

}  // namespace

std::string tableOf(const std::vector<RegistrationRun>& runs) {
  std::string out;
  for (const RegistrationRun& r : runs) {
    append(out, "map of %zu points, %d threads\n", r.map_points, r.threads);
    append(out, "  ready after %.2f s: order %.2f, index %.2f, planes %.2f; %.1f bytes a point\n",
           r.load_s, r.sort_s, r.index_s, r.planes_s, r.bytes_a_point);
    append(out, "  %zu points have a plane (%.1f %%)\n", r.planar,
           100.0 * static_cast<double>(r.planar) / static_cast<double>(r.map_points));
    if (r.scans > 0) {
      append(out, "  %zu scans of %.0f points, %.0f used, %.0f matched; %zu accepted; %.1f steps\n",
             r.scans, r.points_in, r.points_used, r.matched, r.accepted, r.iterations);
      append(out, "  %-22s %9s %9s %9s\n", "", "p50", "p95", "p99");
      appendQuantiles(out, "filter (ms)", r.filter_ms, 1);
      appendQuantiles(out, "match (ms)", r.match_ms, 1);
      appendQuantiles(out, "  association", r.association_ms, 1);
      appendQuantiles(out, "  solve", r.solve_ms, 1);
      appendQuantiles(out, "  information", r.information_ms, 1);
      appendQuantiles(out, "  these three together", r.pose_ms, 1);
      appendQuantiles(out, "  spectrum", r.spectrum_ms, 1);
      appendQuantiles(out, "on processors (ms)", r.cpu_ms, 1);
      appendQuantiles(out, "error (mm)", r.error_m, 1e3);
      appendQuantiles(out, "error (mrad)", r.error_rad, 1e3);
    }
    out += '\n';
  }
  return out;
}

Json jsonOf(const std::vector<RegistrationRun>& runs) {
  Json json = runs.empty() ? Json::object() : jsonOf(runs.back());
  json["runs"] = Json::array();
  for (const RegistrationRun& r : runs) json["runs"].push_back(jsonOf(r));
  return json;
}

}  // namespace paloc
