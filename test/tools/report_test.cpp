#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "paloc/core/errors.h"
#include "paloc/tools/density_image.h"
#include "paloc/tools/html_text.h"
#include "paloc/tools/report_data.h"
#include "paloc/tools/report_summary.h"
#include "paloc/tools/svg_time_plot.h"
#include "report_example.h"
#include "temp_dir.h"

namespace paloc {
namespace {

std::string written(const ReportData& data) {
  const test::TempDir folder;
  writeReport(folder / "report.html", data);
  return test::readFile(folder / "report.html");
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// Every element is closed in its order, attributes are quoted, and no bare `&` or `<` is left. The
// report is written so that XML's rules hold, too. Returns what is wrong, or nothing.
std::string illFormed(const std::string& html) {
  std::vector<std::string> open;
  std::size_t at = html.find("<html");
  while ((at = html.find('<', at)) != std::string::npos) {
    std::size_t end = at + 1;
    for (bool quoted = false; end < html.size() && (quoted || html[end] != '>'); ++end) {
      if (html[end] == '"') quoted = !quoted;
      if (html[end] == '<') return "a '<' within a tag near " + html.substr(at, 60);
    }
    const std::string tag = html.substr(at + 1, end - at - 1);
    const std::string name = tag.substr(0, tag.find_first_of(" \n"));
    at = end;
    if (tag.back() == '/') continue;
    if (tag.front() != '/') {
      open.push_back(name);
    } else if (open.empty() || open.back() != tag.substr(1)) {
      return "<" + tag + "> closes <" + (open.empty() ? "" : open.back()) + ">";
    } else {
      open.pop_back();
    }
  }
  for (at = html.find('&'); at != std::string::npos; at = html.find('&', at + 1)) {
    const std::size_t end = html.find(';', at);
    if (end == std::string::npos || end - at > 6) return "a bare & near " + html.substr(at, 40);
  }
  return open.empty() ? "" : "<" + open.back() + "> stays open";
}

void expectSelfContained(const std::string& html) {
  for (const char* external :
       {"http:", "https:", "//www", "<script", "<link", "@import", "url(", "src="}) {
    EXPECT_FALSE(contains(html, external)) << external;
  }
  for (std::size_t at = html.find("href=\""); at != std::string::npos;
       at = html.find("href=\"", at + 1)) {
    const std::string target = html.substr(at + 6, 22);
    EXPECT_TRUE(target[0] == '#' || target == "data:image/png;base64,") << target;
  }
}

// A number that is none would be written as "nan", or as the dash that stands for it in texts.
void expectNoBrokenNumber(std::string html) {
  const std::string picture = "data:image/png;base64,";
  for (std::size_t at = html.find(picture); at != std::string::npos; at = html.find(picture)) {
    html.erase(at, html.find('"', at) - at);  // letters by chance
  }
  for (const char* broken : {"nan\"", "nan ", "nan<", "inf\"", "inf ", "inf<", "=\"\xE2\x80\x93",
                             "M\xE2\x80\x93", "L\xE2\x80\x93"}) {
    EXPECT_FALSE(contains(html, broken)) << broken;
  }
}

TEST(Report, IsWellFormedAndSelfContained) {
  const std::string html = written(test::exampleReport());
  EXPECT_EQ(illFormed(html), "");
  expectSelfContained(html);
  EXPECT_TRUE(contains(html, "<h1>floor &lt;3&gt; &amp; roof.rawlog</h1>"));
  EXPECT_FALSE(contains(html, "floor <3>"));
  expectNoBrokenNumber(html);
}

TEST(Report, ShowsTheFiguresThatItWasGiven) {
  const ReportData data = test::exampleReport();
  const ReportSummary s = summaryOf(data.result);
  EXPECT_EQ(s.poses, 600U);
  EXPECT_EQ(s.count(PoseFlag::kDegenerate) + s.count(PoseFlag::kGood) +
                s.count(PoseFlag::kCoasting) + s.count(PoseFlag::kLost),
            600U);
  const std::string html = written(data);
  EXPECT_TRUE(contains(html, "600 poses"));
  EXPECT_TRUE(contains(html, shareText(s.count(PoseFlag::kGood), 600)));
  EXPECT_TRUE(contains(html, lengthText(s.position_sigma_median_m)));
  EXPECT_TRUE(contains(html, lengthText(s.position_sigma_worst_m)));
  EXPECT_TRUE(contains(html, lengthText(s.residual_median_m)));
  EXPECT_TRUE(contains(html, "15.4 \xC3\x97 real time"));
  EXPECT_TRUE(contains(html, "412 MB"));
  EXPECT_TRUE(contains(html, "along body x"));
  EXPECT_TRUE(contains(
      html, "refused: low overlap (" + std::to_string(s.count(PoseFlag::kCoasting)) + ")"));
  EXPECT_TRUE(contains(html, "not a sensor that is used"));
  EXPECT_TRUE(contains(html,
                       "1\xE2\x80\xAF"
                       "812 in total"));
  EXPECT_TRUE(contains(html, "which fits m/s2 &amp; not g."));
  EXPECT_TRUE(contains(html, "fnv1a64:0123456789abcdef"));
  EXPECT_TRUE(contains(html, "max_points: 4000  # &lt;after thinning&gt;"));
  EXPECT_TRUE(
      contains(html, "paloc replay &#39;floor &lt;3&gt; &amp; roof.rawlog&#39; --map map.ply"));
  EXPECT_TRUE(contains(html, "3 frames came before the first pose was found"));
  EXPECT_TRUE(contains(html, "1645002364.537699938 s"));
  EXPECT_TRUE(contains(html, "2.51</td>"));  // seconds of "map match"
}

TEST(Report, SameDataSameBytes) {
  EXPECT_EQ(written(test::exampleReport()), written(test::exampleReport()));
}

TEST(Report, NoTrajectorySaysWhy) {
  ReportData data = test::exampleReport();
  data.result.trajectory.clear();
  for (auto& frame : data.result.diagnostics) frame.match.refusal = MatchRefusal::kOutsideMap;
  data.result.no_trajectory_reason = "None of 600 scans lies in the map.";
  const std::string html = written(data);
  EXPECT_EQ(illFormed(html), "");
  EXPECT_TRUE(contains(html, "No trajectory</h2>"));
  EXPECT_TRUE(contains(html, "None of 600 scans lies in the map."));
  EXPECT_TRUE(contains(html, "outside the map"));
  EXPECT_FALSE(contains(html, "one standard deviation of position"));

  ReportData nothing;
  nothing.name = "empty.rawlog";
  const std::string bare = written(nothing);
  EXPECT_EQ(illFormed(bare), "");
  EXPECT_TRUE(contains(bare, "No pose was found in the map."));
}

TEST(Report, OddNumbersBreakNothing) {
  ReportData data = test::exampleReport();
  data.result.trajectory.resize(1);  // no time, no way
  EXPECT_EQ(illFormed(written(data)), "");
  data = test::exampleReport();
  for (auto& frame : data.result.diagnostics) frame.match.residual_rms_m = NAN;
  data.result.trajectory[5].covariance(0, 0) = NAN;
  data.result.trajectory[6].covariance.setZero();
  data.map_points.assign(10, {1e6F, 1e6F, 1e6F});
  const std::string html = written(data);
  EXPECT_EQ(illFormed(html), "");
  expectNoBrokenNumber(html);
  // A sigma that is not a number must not look like a good one.
  EXPECT_TRUE(std::isinf(summaryOf(data.result).position_sigma_worst_m));
  data.map_points.clear();
  EXPECT_FALSE(contains(written(data), "<image"));
}

TEST(Report, UnwritablePlaceIsSaid) {
  const test::TempDir folder;
  EXPECT_THROW(writeReport(folder / "no" / "report.html", test::exampleReport()), IoError);
}

TEST(Verdict, TellsHowFarToTrust) {
  ReportData data = test::exampleReport();
  Verdict verdict = judge(data.result, summaryOf(data.result), data.end);
  EXPECT_EQ(verdict.code, ExitCode::kDegraded);
  EXPECT_EQ(verdict.headline, "Part of the trajectory is lost");
  for (auto& point : data.result.trajectory) point.flag = PoseFlag::kGood;
  data.result.repairs = {};
  verdict = judge(data.result, summaryOf(data.result), data.end);
  EXPECT_EQ(verdict.code, ExitCode::kGood);
  EXPECT_TRUE(contains(verdict.sentence, "All 600 poses")) << verdict.sentence;
  data.end.interrupted = true;
  verdict = judge(data.result, summaryOf(data.result), data.end);
  EXPECT_EQ(verdict.code, ExitCode::kDegraded);
  EXPECT_TRUE(contains(verdict.sentence, "stopped before the recording's end"));
}

TEST(FlagStretches, CutWhereTheFlagChanges) {
  std::vector<TrajectoryPoint> trajectory(6);
  const PoseFlag flags[] = {PoseFlag::kGood, PoseFlag::kGood,       PoseFlag::kCoasting,
                            PoseFlag::kGood, PoseFlag::kDegenerate, PoseFlag::kDegenerate};
  for (std::size_t i = 0; i < 6; ++i) {
    trajectory[i].t_ns = static_cast<TimeNs>(i) * 100;
    trajectory[i].flag = flags[i];
  }
  const auto stretches = flagStretches(trajectory);
  ASSERT_EQ(stretches.size(), 4U);
  EXPECT_EQ(stretches[0].count, 2U);
  EXPECT_EQ(stretches[1].begin_ns, 200);
  EXPECT_EQ(stretches[1].end_ns, 200);
  EXPECT_EQ(stretches[3].first, 4U);
  EXPECT_EQ(stretches[3].last(), 5U);
  EXPECT_TRUE(flagStretches({}).empty());
}

// Reads back what encodePng made of an image: its palette indices.
std::string decodedRows(const std::string& png) {
  const auto number = [&](std::size_t at) {
    std::size_t value = 0;
    for (std::size_t k = 0; k < 4; ++k)
      value = value * 256 + static_cast<unsigned char>(png[at + k]);
    return value;
  };
  for (std::size_t at = 8; at + 12 <= png.size(); at += 12 + number(at)) {
    const auto* body = reinterpret_cast<const Bytef*>(png.data() + at + 4);
    EXPECT_EQ(crc32(0, body, static_cast<uInt>(number(at) + 4)), number(at + 8 + number(at)));
    if (png.substr(at + 4, 4) != "IDAT") continue;
    std::string rows(1000, '\0');
    uLongf size = rows.size();
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(rows.data()), &size, body + 4, number(at)), Z_OK);
    return rows.substr(0, size);
  }
  return "no IDAT";
}

TEST(PngImage, HoldsWhatWasDrawn) {
  OpacityImage image{3, 2, {0, 1, 2, 253, 254, 255}, 10, 20, 30};
  const std::string png = encodePng(image);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(decodedRows(png), std::string("\0\0\1\2\0\xFD\xFE\xFF", 8));
  EXPECT_EQ(png.substr(png.size() - 8, 4), "IEND");
}

TEST(PngImage, Base64OfTheRfc) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(DensityImage, PutsPointsWhereTheyAre) {
  const std::vector<Point3f> points{{0.5F, 9, 1.5F}, {0.6F, -9, 1.6F}, {2.5F, 0, 0.5F}, {50, 0, 0}};
  const OpacityImage image = densityImage(points, 0, 2, {0, 3}, {0, 2}, 3);
  ASSERT_EQ(image.width, 3U);
  ASSERT_EQ(image.height, 2U);
  EXPECT_EQ(image.opacity[0], 255);  // two points, above
  EXPECT_GT(image.opacity[5], 0);    // one, below
  EXPECT_LT(image.opacity[5], 255);
  EXPECT_EQ(std::count(image.opacity.begin(), image.opacity.end(), 0), 4);
}

TEST(TimePlot, KeepsThePeakOfALongRecording) {
  TimePlot plot;
  plot.title = "x";
  plot.time_s = {0, 1000};
  PlotLine line{"s1", "x", {}, {}, false};
  for (int i = 0; i < 100'000; ++i) {
    line.t_s.push_back(0.01 * i);
    line.values.push_back(i == 54'321 ? 10 : 1);
  }
  plot.lines = {line};
  const std::string figure = timePlotFigure(plot);
  EXPECT_LT(figure.size(), 120'000U);
  // The peak is at the top of the axis, which ends 6 % above it.
  const double y = 8 + (1 - 1 / 1.06) * 172;
  EXPECT_TRUE(contains(figure, ' ' + svgNumber(y))) << svgNumber(y);
}

TEST(HtmlText, Forms) {
  EXPECT_EQ(escapeHtml("<a href=\"x\">'&'\x01</a>"),
            "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;\xEF\xBF\xBD&lt;/a&gt;");
  EXPECT_EQ(fixedNumber(-0.0001, 2), "0.00");
  EXPECT_EQ(fixedNumber(NAN, 2), "\xE2\x80\x93");
  EXPECT_EQ(shortNumber(0.01234), "0.0123");
  EXPECT_EQ(shortNumber(1250), "1250");
  EXPECT_EQ(shortNumber(0), "0.00");
  EXPECT_EQ(shareText(1, 100'000), "less than 0.1 %");
  EXPECT_EQ(shareText(99'999, 100'000), "99.9 %");
  EXPECT_EQ(shareText(5, 5), "100 %");
  EXPECT_EQ(countText(1234567),
            "1\xE2\x80\xAF"
            "234\xE2\x80\xAF"
            "567");
  EXPECT_EQ(countText(999), "999");
  EXPECT_EQ(lengthText(0.0082), "8.2 mm");
  EXPECT_EQ(lengthText(0.25), "25.0 cm");
  EXPECT_EQ(sizeText(1'234'567'890), "1.23 GB");
}

}  // namespace
}  // namespace paloc
