#include "paloc/tools/trajectory_covariance.h"

#include <cmath>

#include "csv_rows.h"
#include "paloc/core/errors.h"
#include "paloc/core/text.h"
#include "paloc/tools/trajectory_csv.h"

namespace paloc {
namespace {

constexpr double kUnitTolerance =
    1e-3;  // of a quaternion's length: six digits and more are written

constexpr std::size_t kPose = 1, kCovariance = 8, kFlag = kCovariance + 21;

std::vector<std::string> columns() {
  std::vector<std::string> names{"t_s", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"};
  for (std::string& name : covarianceColumns()) names.push_back(std::move(name));
  names.emplace_back("flag");
  return names;
}

Pose poseOf(const CsvRows& rows) {
  Pose pose;
  for (int i = 0; i < 3; ++i) pose.position[i] = rows.number(kPose + static_cast<std::size_t>(i));
  const Quat q(rows.number(kPose + 6), rows.number(kPose + 3), rows.number(kPose + 4),
               rows.number(kPose + 5));
  if (!pose.position.allFinite()) rows.fail("the position is not finite");
  if (!(std::abs(q.norm() - 1) < kUnitTolerance)) rows.fail("qx qy qz qw is no unit quaternion");
  pose.rotation = q.normalized().toRotationMatrix();
  return pose;
}

}  // namespace

std::vector<CovariantPose> readTrajectoryCovariance(const std::filesystem::path& file) {
  CsvRows rows(file, columns());
  std::vector<CovariantPose> poses;
  while (rows.next()) {
    CovariantPose row;
    row.pose = {rows.time(0), poseOf(rows)};
    std::size_t at = kCovariance;
    for (int r = 0; r < 6; ++r) {
      for (int c = r; c < 6; ++c) row.covariance(r, c) = row.covariance(c, r) = rows.number(at++);
    }
    row.flag = rows.text(kFlag);
    poses.push_back(std::move(row));
  }
  if (poses.empty()) throw IoError(text(file.string(), ": holds no pose"));
  return poses;
}

}  // namespace paloc
