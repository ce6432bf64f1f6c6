#include "paloc/tools/dense_output.h"

#include <fstream>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"
#include "paloc/frontends/tum_file.h"
#include "paloc/tools/trajectory_csv.h"

namespace paloc {
namespace {

// The first field of a line, without what follows; empty for a comment or a blank line.
std::string firstField(const std::string& line) {
  const std::size_t start = line.find_first_not_of(" \t\r");
  if (start == std::string::npos || line[start] == '#') return {};
  return line.substr(start, line.find_first_of(" \t\r,;", start) - start);
}

}  // namespace

std::vector<TimeNs> readStamps(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw IoError(file.string() + ": cannot read this file of stamps");
  std::vector<TimeNs> stamps;
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    const std::string field = firstField(line);
    if (field.empty()) continue;
    TimeNs t_ns = 0;
    if (!parseSeconds(field, t_ns)) {
      throw IoError(text(file.string(), ":", number, ": '", field, "' is not a time in seconds"));
    }
    stamps.push_back(t_ns);
  }
  if (stamps.empty()) throw IoError(file.string() + ": there is no stamp in this file");
  return stamps;
}

DensePoses posesAt(const DenseTrajectory& trajectory, const std::vector<TimeNs>& stamps) {
  DensePoses poses;
  for (const TimeNs t_ns : stamps) {
    if (auto point = trajectory.at(t_ns)) {
      poses.points.push_back(*point);
    } else {
      ++poses.not_answered;
    }
  }
  return poses;
}

std::string writeDensePoses(const ResultFolder& folder, const std::string& name,
                            const DensePoses& poses) {
  writeTum(folder.file((name + ".tum").c_str()), stampedPoses(poses.points));
  writeTextFile(folder.file((name + "_cov.csv").c_str()), trajectoryCsv(poses.points));
  std::string told = text(poses.points.size(), " poses in ", name, ".tum");
  if (poses.not_answered > 0) {
    told += text("; ", poses.not_answered, " stamps lie outside the trajectory or in a gap");
  }
  return told + '\n';
}

}  // namespace paloc
