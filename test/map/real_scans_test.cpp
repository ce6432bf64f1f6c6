#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iostream>

#include "paloc/core/mrpt_pose.h"
#include "paloc/map/cloud_io.h"
#include "paloc/map/scan_matcher.h"
#include "shared_data.h"

namespace paloc {
namespace {

// Every 24th scan of a hand-held solid-state LiDAR, from 9 cm and 0.6 degrees off its truth.
TEST(RealScans, AreRegisteredToTheirMap) {
  const std::filesystem::path folder = sharedData() / "e1r";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const auto map = PriorMap::load(folder / "map.ply", {});
  const auto matcher = ScanMatcher::onto(map, {});
  std::ifstream times(folder / "times.txt"), truths(folder / "truth.tum");
  std::string name;
  double stamp = 0, squares = 0, worst = 0;
  int tried = 0, accepted = 0;
  for (int index = 0; times >> name >> stamp; ++index) {
    Pose truth;
    Eigen::Quaterniond q;
    truths >> stamp >> truth.position.x() >> truth.position.y() >> truth.position.z() >> q.x() >>
        q.y() >> q.z() >> q.w();
    truth.rotation = q.normalized().toRotationMatrix();
    if (index % 24 != 0) continue;
    ++tried;
    Scan scan;
    scan.points_body = loadCloud(folder / "scans" / name).points;
    Vec6 off;
    off.head<3>() = 0.09 * Vec3(std::cos(index), std::sin(index), 0.5).normalized();
    off.tail<3>() = 0.6 * M_PI / 180 * Vec3(0.3, std::sin(index), std::cos(index)).normalized();
    const MapMatch match = matcher->match(scan, toMrpt(boxplus(truth, off)), 0.05, 0.01);
    if (!match.accepted()) continue;
    ++accepted;
    const double error = (fromMrpt(match.T_map_body).position - truth.position).norm();
    squares += error * error;
    worst = std::max(worst, error);
  }
  const double rmse = std::sqrt(squares / std::max(accepted, 1));
  std::cout << accepted << " of " << tried << " scans, " << rmse * 100 << " cm RMSE, "
            << worst * 100 << " cm at worst\n";
  EXPECT_GE(accepted, tried - 1);
  EXPECT_LT(rmse, 0.04);
  EXPECT_LT(worst, 0.09);
}

}  // namespace
}  // namespace paloc
