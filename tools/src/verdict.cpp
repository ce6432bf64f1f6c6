#include "paloc/tools/verdict.h"

#include <algorithm>

#include "paloc/tools/html_text.h"

namespace paloc {
namespace {

std::string cameOut(const ReportSummary& s) {
  return counted(s.poses, "pose", "poses") + " over " + fixedNumber(s.duration_s, 1) + " s and " +
         shortNumber(s.length_m) + " m";
}

std::string sigmaText(const ReportSummary& s) {
  return "one standard deviation of position along its worst direction is " +
         lengthText(s.position_sigma_median_m) + " at the median and " +
         lengthText(s.position_sigma_worst_m) + " at worst";
}

// "12 are coasting (no map factor near), 3 are lost"
std::string doubts(const ReportSummary& s) {
  struct Doubt {
    PoseFlag flag;
    const char* meaning;
  };
  std::string text;
  for (const Doubt& doubt :
       {Doubt{PoseFlag::kDegenerate, "degenerate (the map leaves a direction weak or open)"},
        Doubt{PoseFlag::kCoasting, "coasting (no map factor near)"},
        Doubt{PoseFlag::kLost, "lost (not to be used)"}}) {
    const std::size_t n = s.count(doubt.flag);
    if (n == 0) continue;
    if (!text.empty()) text += ", ";
    text += countText(n) + (n == 1 ? " is " : " are ") + doubt.meaning;
  }
  return text;
}

std::string asSentence(std::string text) {
  if (!text.empty() && text.back() != '.') text += '.';
  return text;
}

// What lies beside the poses: each a sentence, with a headline should it be the worst there is.
struct Blemish {
  std::string headline, sentence;
};

std::vector<Blemish> blemishesOf(const Result& result, const RunEnd& end) {
  std::vector<Blemish> found;
  if (!end.damage.empty()) {
    found.push_back({"The recording is damaged",
                     "The recording is damaged, and only what comes before that is used: " +
                         asSentence(end.damage)});
  }
  if (end.interrupted) {
    found.push_back({"Stopped before the end", "The run was stopped before the recording's end."});
  }
  for (const std::string& problem : end.problems) {
    found.push_back({"Not all that was asked for is there", "Note that " + asSentence(problem)});
  }
  if (result.batch_failed) {
    found.push_back(
        {"Not smoothed as a whole", "Smoothing the whole failed, so the online result stands."});
  }
  if (const auto repairs = result.repairs.total(); repairs > 0) {
    found.push_back({"The smoother needed repairs",
                     "The smoother made " + counted(repairs, "repair", "repairs") + '.'});
  }
  return found;
}

std::string headlineOf(const ReportSummary& s, const std::vector<Blemish>& blemishes) {
  if (s.count(PoseFlag::kLost) > 0) return "Part of the trajectory is lost";
  if (s.count(PoseFlag::kCoasting) > 0) return "Part of the trajectory is not held by the map";
  if (s.count(PoseFlag::kDegenerate) > 0) return "Part of the trajectory is held weakly by the map";
  return blemishes.empty() ? "Held by the map throughout" : blemishes.front().headline;
}

// A recording of which no scan can be used is to blame itself, not the start in the map.
bool hadNoScan(const Result& result) {
  return std::all_of(
      result.diagnostics.begin(), result.diagnostics.end(),
      [](const FrameDiagnostics& d) { return d.match.refusal == MatchRefusal::kNoScan; });
}

Verdict withoutTrajectory(const Result& result, const RunEnd& end) {
  const bool unusable = hadNoScan(result) && !end.interrupted;
  std::vector<std::string> reasons;
  if (end.interrupted) reasons.emplace_back("the run was stopped before the first pose was found");
  if (!hadNoScan(result)) reasons.push_back(result.no_trajectory_reason);
  if (!end.damage.empty()) reasons.push_back(end.damage);
  reasons.insert(reasons.end(), end.problems.begin(), end.problems.end());
  if (reasons.empty()) reasons.push_back(result.no_trajectory_reason);
  std::string sentence;
  for (const std::string& reason : reasons) {
    if (!reason.empty()) sentence += (sentence.empty() ? "" : "; ") + reason;
  }
  if (sentence.empty()) sentence = "No pose was found in the map";
  return {unusable ? ExitCode::kInput : ExitCode::kNoLocalization,
          unusable ? "unusable recording" : "no localization", "No trajectory",
          asSentence(sentence)};
}

}  // namespace

Verdict judge(const Result& result, const ReportSummary& s, const RunEnd& end) {
  if (s.poses == 0) return withoutTrajectory(result, end);
  const std::vector<Blemish> blemishes = blemishesOf(result, end);
  const bool all_good = s.count(PoseFlag::kGood) == s.poses;
  const bool good = all_good && blemishes.empty();
  std::string sentence =
      all_good ? "All " + cameOut(s) + " are fixed by the map in all six directions; "
               : "Of " + cameOut(s) + ", " + shareText(s.count(PoseFlag::kGood), s.poses) +
                     " are fixed by the map in all six directions; " + doubts(s) + "; ";
  sentence += sigmaText(s) + '.';
  for (const Blemish& blemish : blemishes) sentence += ' ' + blemish.sentence;
  return {good ? ExitCode::kGood : ExitCode::kDegraded, good ? "good" : "degraded",
          headlineOf(s, blemishes), sentence};
}

}  // namespace paloc
