#pragma once

#include <string>

#include "paloc/tools/report_data.h"
#include "paloc/tools/report_summary.h"

/// The parts of report.html. Each returns a whole `<section>`, or nothing where there is nothing to
/// say.
namespace paloc::report {

/// The style sheet, for light and dark.
std::string styleSheet();

std::string verdictSection(const ReportData& data, const ReportSummary& summary);
std::string keyFigures(const ReportData& data, const ReportSummary& summary);
std::string mapSection(const ReportData& data, const ReportSummary& summary);
std::string timeSection(const ReportData& data, const ReportSummary& summary);
std::string stretchesSection(const ReportData& data, const ReportSummary& summary);
std::string mapFactorsSection(const ReportData& data, const ReportSummary& summary);
std::string unusedSection(const ReportData& data);
std::string notesSection(const ReportData& data);
std::string stagesSection(const ReportData& data);
std::string filesSection(const ReportData& data);
std::string reproduceSection(const ReportData& data);

}  // namespace paloc::report
