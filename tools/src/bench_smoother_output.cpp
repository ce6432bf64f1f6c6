#include <cstdarg>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "paloc/tools/bench_smoother.h"

namespace paloc {
namespace {

using Json = nlohmann::ordered_json;

Json jsonOf(const TimeStatistics& t) { return {{"p50", t.p50}, {"p99", t.p99}, {"max", t.max}}; }

Json jsonOf(const StateErrors& errors) {
  if (errors.position_m.count == 0) {
    return {{"count", 0}, {"position_rmse_m", nullptr}, {"rotation_rmse_rad", nullptr}};
  }
  return {{"count", errors.position_m.count},
          {"position_rmse_m", errors.position_m.rmse},
          {"rotation_rmse_rad", errors.rotation_rad.rmse},
          {"position_max_m", errors.position_m.max},
          {"rotation_max_rad", errors.rotation_rad.max}};
}

__attribute__((format(printf, 2, 3))) void append(std::string& out, const char* format, ...) {
  char line[200];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  out += line;
}

void appendErrors(std::string& out, const char* name, const StateErrors& errors) {
  if (errors.position_m.count == 0) {
    append(out, "%-24s no state\n", name);
    return;
  }
  append(out, "%-24s %9.3f mm %9.4f mrad   (%zu states)\n", name, 1e3 * errors.position_m.rmse,
         1e3 * errors.rotation_rad.rmse, errors.position_m.count);
}

void appendTimes(std::string& out, const char* name, const TimeStatistics& t) {
  append(out, "%-24s %9.4f %9.4f %9.4f\n", name, t.p50, t.p99, t.max);
}

}  // namespace

std::string tableOf(const BenchSmootherResult& r) {
  std::string out;
  append(out, "nodes %zu, lag %g s\n\nRMSE of                    position     rotation\n", r.nodes,
         r.lag_s);
  appendErrors(out, "newest state", r.newest);
  appendErrors(out, "state leaving the window", r.leaving);
  if (r.batch) appendErrors(out, "batch", *r.batch);
  append(out, "\ntime per update (ms)           p50       p99       max\n");
  appendTimes(out, "whole, by the clock", r.update_ms);
  appendTimes(out, "whole, on the processor", r.update_cpu_ms);
  appendTimes(out, "  preintegration", r.preintegration_ms);
  appendTimes(out, "  smoother", r.smoother_ms);
  appendTimes(out, "    (linearizing a node)", r.linearization_ms);
  appendTimes(out, "  newest covariance", r.covariance_ms);
  append(out, "\nrelinearized nodes %zu, repairs %zu, late measurements refused %zu\n",
         r.relinearized, static_cast<std::size_t>(r.repairs.total()), r.late_refused);
  if (r.batch) {
    append(out, "batch: %.3f s, %d iterations, %s\n", r.batch_time_s, r.batch_iterations,
           r.batch_converged ? "converged" : "not converged");
  }
  append(out, "peak memory %.1f MB\n", r.peak_rss_mb);
  return out;
}

Json jsonOf(const BenchSmootherResult& r) {
  Json json;
  json["nodes"] = r.nodes;
  json["lag_s"] = r.lag_s;
  json["update_ms"] = jsonOf(r.update_ms);
  json["update_cpu_ms"] = jsonOf(r.update_cpu_ms);
  json["parts_cpu_ms"] = {{"preintegration", jsonOf(r.preintegration_ms)},
                          {"smoother", jsonOf(r.smoother_ms)},
                          {"linearization_of_one_node", jsonOf(r.linearization_ms)},
                          {"newest_covariance", jsonOf(r.covariance_ms)}};
  json["newest"] = jsonOf(r.newest);
  json["leaving"] = jsonOf(r.leaving);
  json["batch"] = r.batch ? jsonOf(*r.batch) : Json(nullptr);
  if (r.batch) {
    json["batch"]["time_s"] = r.batch_time_s;
    json["batch"]["iterations"] = r.batch_iterations;
    json["batch"]["converged"] = r.batch_converged;
  }
  json["relinearized"] = r.relinearized;
  json["late_refused"] = r.late_refused;
  json["repairs"] = {{"damped", r.repairs.damped},
                     {"factors_dropped", r.repairs.factors_dropped},
                     {"reanchored", r.repairs.reanchored}};
  json["peak_rss_mb"] = r.peak_rss_mb;
  return json;
}

}  // namespace paloc
