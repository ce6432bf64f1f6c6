#include <algorithm>
#include <cmath>
#include <map>

#include "paloc/core/direction_name.h"
#include "paloc/tools/html_table.h"
#include "paloc/tools/html_text.h"
#include "paloc/tools/report_sections.h"

namespace paloc::report {
namespace {

constexpr auto kNumber = HtmlTable::Align::kNumber;
constexpr auto kText = HtmlTable::Align::kText;
constexpr std::size_t kMostStretches = 200;

const FrameDiagnostics* frameAt(const std::vector<FrameDiagnostics>& frames, TimeNs t_ns) {
  const auto it = std::lower_bound(frames.begin(), frames.end(), t_ns,
                                   [](const FrameDiagnostics& f, TimeNs t) { return f.t_ns < t; });
  return it != frames.end() && it->t_ns == t_ns ? &*it : nullptr;
}

// Which directions the map left weak or open in a stretch, the most frequent first.
std::string weakDirections(const Result& result, const FlagStretch& stretch) {
  std::map<std::string, std::size_t> counts;
  for (std::size_t i = stretch.first; i <= stretch.last(); ++i) {
    const FrameDiagnostics* frame = frameAt(result.diagnostics, result.trajectory[i].t_ns);
    if (!frame || !frame->match.accepted()) continue;
    for (std::size_t k = 0; k < 6; ++k) {
      const MatchDirection& direction = frame->match.directions[k];
      if (direction.cls != DirectionClass::kFull)
        ++counts[directionName(direction.axis_body, k >= 3)];
    }
  }
  std::vector<std::pair<std::string, std::size_t>> sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, sorted.size()); ++i) {
    text += (i > 0 ? ", " : "") + sorted[i].first;
  }
  return text;
}

// What keeps the map from fixing a stretch: the reasons of refused matches, or the weak directions.
std::string causeOf(const Result& result, const FlagStretch& stretch) {
  std::map<MatchRefusal, std::size_t> refusals;
  for (std::size_t i = stretch.first; i <= stretch.last(); ++i) {
    const FrameDiagnostics* frame = frameAt(result.diagnostics, result.trajectory[i].t_ns);
    if (frame && !frame->match.accepted()) ++refusals[frame->match.refusal];
  }
  std::string text = weakDirections(result, stretch);
  for (const auto& [refusal, count] : refusals) {
    text += (text.empty() ? "" : "; ") + std::string("refused: ") + toString(refusal) + " (" +
            countText(count) + ")";
  }
  return text.empty() ? "\xE2\x80\x93" : text;
}

double wayOf(const std::vector<TrajectoryPoint>& trajectory, const FlagStretch& stretch) {
  double way_m = 0;
  for (std::size_t i = stretch.first + 1; i <= stretch.last(); ++i) {
    way_m += (trajectory[i].T_map_body.translation() - trajectory[i - 1].T_map_body.translation())
                 .norm();
  }
  return way_m;
}

double worstSigma(const std::vector<TrajectoryPoint>& trajectory, const FlagStretch& stretch) {
  double worst = 0;
  for (std::size_t i = stretch.first; i <= stretch.last(); ++i) {
    const double sigma = positionSigma(trajectory[i]);
    if (!(sigma <= worst)) worst = sigma;
  }
  return worst;
}

std::string stretchesTable(const Result& result, const std::vector<FlagStretch>& stretches) {
  const TimeNs zero_ns = result.diagnostics.empty() ? result.trajectory.front().t_ns
                                                    : std::min(result.diagnostics.front().t_ns,
                                                               result.trajectory.front().t_ns);
  HtmlTable table("Stretches in order of time", {{"Flag", kText},
                                                 {"From (s)", kNumber},
                                                 {"To (s)", kNumber},
                                                 {"Poses", kNumber},
                                                 {"Way", kNumber},
                                                 {"Sigma at worst", kNumber},
                                                 {"Weak directions, refusals", kText}});
  for (std::size_t i = 0; i < std::min(stretches.size(), kMostStretches); ++i) {
    const FlagStretch& s = stretches[i];
    const std::string flag = toString(s.flag);
    table.addRow({"<span class=\"flag " + flag + "\">" + flag + "</span>",
                  fixedNumber(secondsBetween(zero_ns, s.begin_ns), 2),
                  fixedNumber(secondsBetween(zero_ns, s.end_ns), 2), countText(s.count),
                  lengthText(wayOf(result.trajectory, s)),
                  lengthText(worstSigma(result.trajectory, s)), escapeHtml(causeOf(result, s))});
  }
  std::string html = table.html();
  if (stretches.size() > kMostStretches) {
    html += "<p class=\"lead\">" + countText(stretches.size() - kMostStretches) +
            " more are in trajectory_cov.csv.</p>\n";
  }
  return html;
}

std::string open(const std::string& id, const std::string& title) {
  return "<section aria-labelledby=\"" + id + "\">\n<h2 id=\"" + id + "\">" + title + "</h2>\n";
}

std::string repairsTable(const RepairCounts& repairs) {
  if (repairs.total() == 0) return "<p>No numerical repair was needed.</p>\n";
  HtmlTable table("Repairs made by the smoothers", {{"Repair", kText}, {"Count", kNumber}});
  const auto row = [&](const std::string& name, std::uint64_t count) {
    if (count > 0) table.addRow({name, countText(count)});
  };
  row("damping added: the information was not positive definite", repairs.damped);
  row("measurement dropped: not finite, or absurd", repairs.factors_dropped);
  row("window started anew", repairs.reanchored);
  return table.html();
}

std::string barHtml(double share) {
  const std::string percent = fixedNumber(100 * std::clamp(share, 0.0, 1.0), 1);
  return percent +
         " %"
         R"(<span class="bar" aria-hidden="true"><span style="width:)" +
         percent + "%\"></span></span>";
}

}  // namespace

std::string stretchesSection(const ReportData& data, const ReportSummary& summary) {
  if (summary.poses == 0) return "";
  std::vector<FlagStretch> doubtful = summary.stretches;
  std::erase_if(doubtful, [](const FlagStretch& s) { return s.flag == PoseFlag::kGood; });
  const std::string head = open("stretches", "Where to be careful");
  if (doubtful.empty()) return head + "<p>Nowhere: every pose is good.</p>\n</section>\n";
  const std::size_t poses = summary.poses - summary.count(PoseFlag::kGood);
  return head + "<p class=\"lead\">" + counted(poses, "pose", "poses") + " in " +
         counted(doubtful.size(), "stretch", "stretches") +
         ": odometry and IMU carry what the map does not fix.</p>\n" +
         stretchesTable(data.result, doubtful) + "</section>\n";
}

std::string mapFactorsSection(const ReportData& data, const ReportSummary& s) {
  std::string html = open("factors", "Map factors");
  html += "<p class=\"lead\">" + countText(s.map_factors_used) + " of " +
          counted(s.frames, "frame", "frames") + " gave a map factor.";
  if (data.result.frames_before_start > 0) {
    html += ' ' + counted(data.result.frames_before_start, "frame", "frames") +
            " came before the first pose was found.";
  }
  html += "</p>\n";
  if (!s.refusals.empty()) {
    HtmlTable table("Matches refused, by reason",
                    {{"Reason", kText}, {"Frames", kNumber}, {"Share", kNumber}});
    for (const auto& [reason, count] : s.refusals) {
      table.addRow({escapeHtml(reason), countText(count), shareText(count, s.frames)});
    }
    html += table.html();
  }
  return html + repairsTable(data.result.repairs) + "</section>\n";
}

std::string unusedSection(const ReportData& data) {
  std::string html = open("unused", "What was not used, and why");
  if (data.unused.empty()) return html + "<p>No observation was left out.</p>\n</section>\n";
  HtmlTable table("Observations not used",
                  {{"Class", kText}, {"Label", kText}, {"Reason", kText}, {"Count", kNumber}});
  std::uint64_t total = 0;
  for (const UnusedCounts::Row& row : data.unused) {
    total += row.count;
    table.addRow({escapeHtml(row.class_name), escapeHtml(row.label), escapeHtml(row.reason),
                  countText(row.count)});
  }
  return html + "<p class=\"lead\">" + countText(total) + " in total.</p>\n" + table.html() +
         "</section>\n";
}

std::string stagesSection(const ReportData& data) {
  if (data.stages.empty()) return "";
  double total_ms = 0;
  for (const ReportStage& stage : data.stages) total_ms += stage.total_ms;
  HtmlTable table("Time per stage", {{"Stage", kText},
                                     {"Calls", kNumber},
                                     {"p50 (ms)", kNumber},
                                     {"p99 (ms)", kNumber},
                                     {"Total (s)", kNumber},
                                     {"Share", kText}});
  for (const ReportStage& stage : data.stages) {
    table.addRow({escapeHtml(stage.name), countText(stage.calls), shortNumber(stage.p50_ms),
                  shortNumber(stage.p99_ms), shortNumber(stage.total_ms / 1000),
                  barHtml(total_ms > 0 ? stage.total_ms / total_ms : 0)});
  }
  return open("stages", "Where the time went") + table.html() + "</section>\n";
}

std::string filesSection(const ReportData& data) {
  if (data.inputs.empty() && data.output_files.empty()) return "";
  std::string html = open("files", "Files");
  if (!data.inputs.empty()) {
    HtmlTable table(
        "Input",
        {{"What", kText}, {"File", kText}, {"Size", kNumber}, {"Content", kText}, {"Hash", kText}});
    for (const ReportInput& input : data.inputs) {
      table.addRow({escapeHtml(input.role),
                    "<span class=\"break\">" + escapeHtml(input.file) + "</span>",
                    input.size_bytes ? sizeText(*input.size_bytes) : "\xE2\x80\x93",
                    escapeHtml(input.detail),
                    "<code class=\"break\">" + escapeHtml(input.hash) + "</code>"});
    }
    html += table.html();
  }
  if (!data.output_files.empty()) {
    HtmlTable table("Output, beside this report", {{"File", kText}, {"Content", kText}});
    for (const auto& [name, content] : data.output_files) {
      table.addRow({"<code>" + escapeHtml(name) + "</code>", escapeHtml(content)});
    }
    html += table.html();
  }
  return html + "</section>\n";
}

}  // namespace paloc::report
