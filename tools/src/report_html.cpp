#include "paloc/tools/html_text.h"
#include "paloc/tools/report_data.h"
#include "paloc/tools/report_sections.h"
#include "paloc/tools/result_folder.h"

namespace paloc {
namespace {

std::string headOf(const ReportData& data) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
         "<meta name=\"color-scheme\" content=\"light dark\"/>\n<title>" +
         escapeHtml(data.name) + " \xE2\x80\x93 paloc report</title>\n<style>" +
         report::styleSheet() + "</style>\n</head>\n";
}

std::string pageHeader(const ReportData& data) {
  std::string facts;
  const auto add = [&](const std::string& fact) {
    facts += (facts.empty() ? "" : " \xC2\xB7 ") + fact;
  };
  if (!data.frontend.empty()) add("front-end " + escapeHtml(data.frontend));
  if (!data.created.empty()) add(escapeHtml(data.created));
  return "<header>\n<p class=\"kind\">Ground-truth trajectory</p>\n<h1>" + escapeHtml(data.name) +
         "</h1>\n" + (facts.empty() ? "" : "<p class=\"facts\">" + facts + "</p>\n") +
         "</header>\n";
}

// Only what is there is linked.
std::string navigation(const std::string& body) {
  struct Target {
    const char* id;
    const char* name;
  };
  std::string items;
  for (const Target& target :
       {Target{"map", "Map"}, Target{"time", "Over time"},
        Target{"stretches", "Where to be careful"}, Target{"factors", "Map factors"},
        Target{"unused", "Not used"}, Target{"notes", "Notes"}, Target{"stages", "Run time"},
        Target{"files", "Files"}, Target{"reproduce", "Reproduce"}}) {
    if (body.find("<h2 id=\"" + std::string(target.id) + '"') == std::string::npos) continue;
    items += "<li><a href=\"#" + std::string(target.id) + "\">" + target.name + "</a></li>";
  }
  return "<nav aria-label=\"Sections\"><ul>" + items + "</ul></nav>\n";
}

std::string pageOf(const ReportData& data) {
  const ReportSummary summary = summaryOf(data.result);
  const std::string body =
      report::mapSection(data, summary) + report::stretchesSection(data, summary) +
      report::timeSection(data, summary) + report::mapFactorsSection(data, summary) +
      report::unusedSection(data) + report::notesSection(data) + report::stagesSection(data) +
      report::filesSection(data) + report::reproduceSection(data);
  return headOf(data) + "<body>\n<div class=\"page\">\n" + pageHeader(data) + "<main>\n" +
         report::verdictSection(data, summary) + report::keyFigures(data, summary) +
         navigation(body) + body +
         "</main>\n<footer><p>Written by paloc.</p></footer>\n</div>\n</body>\n</html>\n";
}

}  // namespace

void writeReport(const std::filesystem::path& file, const ReportData& data) {
  writeTextFile(file, pageOf(data));
}

}  // namespace paloc
