#include "paloc/tools/scan_times_file.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"
#include "paloc/frontends/tum_file.h"

namespace paloc {
namespace {

ScanEntry parseLine(const std::string& line, const std::filesystem::path& folder,
                    const std::string& where) {
  std::istringstream words(line);
  std::string name, first, last, more;
  words >> name >> first >> last >> more;
  ScanEntry scan;
  scan.file = folder / name;
  if (!more.empty() || first.empty()) {
    throw IoError(text(where, "expected: name stamp_first_s [stamp_last_s]"));
  }
  if (!parseSeconds(first, scan.stamp_ns)) {
    throw IoError(text(where, "'", first, "' is not a time in seconds"));
  }
  if (!last.empty()) {
    TimeNs last_ns = 0;
    if (!parseSeconds(last, last_ns))
      throw IoError(text(where, "'", last, "' is not a time in seconds"));
    constexpr TimeNs kLongest = 4 * kNsPerSecond;  // what 32 bits of nanoseconds hold
    if (last_ns < scan.stamp_ns || last_ns - scan.stamp_ns > kLongest) {
      throw IoError(
          text(where, "the last point's stamp ", last, " is not within 4 s after the first's"));
    }
    scan.last_ns = last_ns;
  }
  return scan;
}

}  // namespace

std::vector<ScanEntry> readScanTimes(const std::filesystem::path& file,
                                     const std::filesystem::path& folder) {
  std::ifstream in(file);
  if (!in) throw IoError(text(file.string(), ": cannot be opened"));
  std::vector<ScanEntry> scans;
  std::string line;
  for (std::uint64_t number = 1; std::getline(in, line); ++number) {
    line.resize(std::min(line.size(), line.find('#')));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    scans.push_back(parseLine(line, folder, text(file.string(), ": line ", number, ": ")));
  }
  if (in.bad()) throw IoError(text(file.string(), ": cannot be read"));
  if (scans.empty()) throw IoError(text(file.string(), ": lists no scan"));
  return scans;
}

}  // namespace paloc
