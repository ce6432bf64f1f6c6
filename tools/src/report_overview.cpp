#include <cmath>
#include <numbers>

#include "paloc/tools/html_text.h"
#include "paloc/tools/report_sections.h"

namespace paloc::report {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

struct Tone {
  const char* css;
  const char* sign;
};

Tone toneOf(ExitCode code) {
  if (code == ExitCode::kGood) return {"good", "\xE2\x9C\x93"};
  if (code == ExitCode::kDegraded) return {"degraded", "!"};
  return {"none", "\xE2\x9C\x95"};
}

std::string figure(const std::string& name, const std::string& value, const std::string& note) {
  return "<div><dt>" + escapeHtml(name) + "</dt><dd>" + escapeHtml(value) +
         "</dd><dd class=\"note\">" + escapeHtml(note) + "</dd></div>\n";
}

std::string angleText(double radians) {
  return std::isfinite(radians) ? shortNumber(kDegrees * radians) + "\xC2\xB0" : "\xE2\x80\x93";
}

double replayedSeconds(const ReportData& data, const ReportSummary& s) {
  return data.recording_time_s > 0 ? data.recording_time_s : s.duration_s;
}

std::string speedFigure(const ReportData& data, const ReportSummary& s) {
  if (data.wall_time_s <= 0) return "";
  const std::string memory =
      data.peak_rss_mb > 0 ? ", peak memory " + fixedNumber(data.peak_rss_mb, 0) + " MB" : "";
  return figure("Speed",
                shortNumber(replayedSeconds(data, s) / data.wall_time_s) + " \xC3\x97 real time",
                fixedNumber(data.wall_time_s, 1) + " s of run time" + memory);
}

}  // namespace

std::string verdictSection(const ReportData& data, const ReportSummary& summary) {
  const Verdict verdict = judge(data.result, summary, data.end);
  const Tone tone = toneOf(verdict.code);
  std::string html = "<section class=\"verdict " + std::string(tone.css) +
                     "\" aria-labelledby=\"verdict\">\n<h2 id=\"verdict\"><span class=\"badge\" "
                     "aria-hidden=\"true\">" +
                     tone.sign + "</span>" + escapeHtml(verdict.headline) + "</h2>\n<p>" +
                     escapeHtml(verdict.sentence) + "</p>\n";
  if (summary.poses > 0) {
    html +=
        "<p class=\"caveat\">The standard deviations are the estimator's own. They hold for the "
        "map as it was given: an error of the map itself, of the extrinsic calibration or of the "
        "clocks is not in them.</p>\n";
  }
  return html + "</section>\n";
}

std::string keyFigures(const ReportData& data, const ReportSummary& s) {
  std::string html = "<dl class=\"figures\">\n";
  if (s.poses > 0) {
    html += figure("Trajectory", counted(s.poses, "pose", "poses"),
                   fixedNumber(s.duration_s, 1) + " s, " + shortNumber(s.length_m) + " m");
    html +=
        figure("Fixed by the map", shareText(s.count(PoseFlag::kGood), s.poses),
               countText(s.count(PoseFlag::kGood)) + " of " + counted(s.poses, "pose", "poses"));
    html += figure("Position, 1 sigma", lengthText(s.position_sigma_median_m),
                   "median; at worst " + lengthText(s.position_sigma_worst_m));
    html += figure("Rotation, 1 sigma", angleText(s.rotation_sigma_median_rad),
                   "median; at worst " + angleText(s.rotation_sigma_worst_rad));
  }
  html += figure("Map factors", shareText(s.map_factors_used, s.frames),
                 countText(s.map_factors_used) + " of " + counted(s.frames, "frame", "frames"));
  if (s.map_factors_used > 0) {
    html += figure("Residual to the map", lengthText(s.residual_median_m),
                   "rms of the inliers, median over the frames");
  }
  html += figure("Repairs", countText(data.result.repairs.total()), "made by the smoothers");
  return html + speedFigure(data, s) + "</dl>\n";
}

std::string notesSection(const ReportData& data) {
  if (data.notes.empty() && data.changes.empty()) return "";
  std::string html =
      "<section aria-labelledby=\"notes\">\n<h2 id=\"notes\">Notes</h2>\n<ul class=\"notes\">\n";
  if (!data.changes.empty()) {
    html +=
        "<li>Differs from the prior map (map_changes.ply): " + escapeHtml(data.changes) + "</li>\n";
  }
  for (const std::string& note : data.notes) html += "<li>" + escapeHtml(note) + "</li>\n";
  return html + "</ul>\n</section>\n";
}

std::string reproduceSection(const ReportData& data) {
  if (data.command_line.empty() && data.versions.empty() && data.settings_yaml.empty()) return "";
  std::string html =
      "<section aria-labelledby=\"reproduce\">\n<h2 id=\"reproduce\">How to reproduce</h2>\n";
  if (!data.command_line.empty()) {
    html +=
        "<p class=\"lead\">The same input gives the same trajectory, byte for byte.</p>\n<pre "
        "class=\"wrap\">" +
        escapeHtml(data.command_line) + "</pre>\n";
  }
  if (!data.versions.empty()) {
    html += "<p class=\"lead\">Versions: ";
    for (std::size_t i = 0; i < data.versions.size(); ++i) {
      if (i > 0) html += ", ";
      html += escapeHtml(data.versions[i].first) + ' ' + escapeHtml(data.versions[i].second);
    }
    html += "</p>\n";
  }
  if (!data.settings_yaml.empty()) {
    html += "<details><summary>Effective settings (YAML)</summary>\n<pre tabindex=\"0\">" +
            escapeHtml(data.settings_yaml) + "</pre></details>\n";
  }
  return html + "</section>\n";
}

}  // namespace paloc::report
