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

constexpr double kDegree = M_PI / 180;

/// The scans of a hand-held solid-state LiDAR, one at a time, with their truth.
class RealScans : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(folder_)) GTEST_SKIP() << folder_ << " is not there";
    static const auto map = PriorMap::load(folder_ / "map.ply", withoutSideFile());
    matcher_ = ScanMatcher::onto(map, {});
  }

  struct Errors {
    int tried = 0, accepted = 0;
    double squares = 0, worst = 0;  ///< of position (m2, m)

    void add(const MapMatch& match, const Pose& truth) {
      ++tried;
      if (!match.accepted()) return;
      ++accepted;
      const double error = (fromMrpt(match.T_map_body).position - truth.position).norm();
      squares += error * error;
      worst = std::max(worst, error);
    }
    double rmse() const { return std::sqrt(squares / std::max(accepted, 1)); }
    void print() const {
      std::cout << accepted << " of " << tried << " scans, " << rmse() * 100 << " cm RMSE, "
                << worst * 100 << " cm at worst\n";
    }
  };

  // Calls use(index, scan, truth) for every `step`-th scan.
  template <typename Use>
  void forEveryNth(int step, const Use& use) const {
    std::ifstream times(folder_ / "times.txt"), truths(folder_ / "truth.tum");
    std::string name;
    double stamp = 0;
    for (int index = 0; times >> name >> stamp; ++index) {
      Pose truth;
      Eigen::Quaterniond q;
      truths >> stamp >> truth.position.x() >> truth.position.y() >> truth.position.z() >> q.x() >>
          q.y() >> q.z() >> q.w();
      truth.rotation = q.normalized().toRotationMatrix();
      if (index % step != 0) continue;
      Scan scan;
      scan.points_body = loadCloud(folder_ / "scans" / name).points;
      use(index, scan, truth);
    }
  }

  static MapSettings withoutSideFile() {
    MapSettings settings;
    settings.side_file = false;
    return settings;
  }

  std::filesystem::path folder_ = sharedData() / "e1r";
  std::shared_ptr<ScanMatcher> matcher_;
};

// Every 24th scan from 9 cm and 0.6 degrees off its truth.
TEST_F(RealScans, AreRegisteredToTheirMap) {
  Errors errors;
  forEveryNth(24, [&](int index, const Scan& scan, const Pose& truth) {
    Vec6 off;
    off.head<3>() = 0.09 * Vec3(std::cos(index), std::sin(index), 0.5).normalized();
    off.tail<3>() = 0.6 * kDegree * Vec3(0.3, std::sin(index), std::cos(index)).normalized();
    errors.add(matcher_->match(scan, toMrpt(boxplus(truth, off)), 0.05, 0.01), truth);
  });
  errors.print();
  EXPECT_GE(errors.accepted, errors.tried - 1);
  EXPECT_LT(errors.rmse(), 0.04);
  EXPECT_LT(errors.worst, 0.09);
}

// Every 12th from half a metre and 10 degrees off, with no IMU to tell the tilt.
TEST_F(RealScans, AreFoundFromARoughPose) {
  Errors errors;
  forEveryNth(12, [&](int index, const Scan& scan, const Pose& truth) {
    Vec6 off;
    off.head<3>() = 0.5 * Vec3(std::cos(index), std::sin(index), 0.5).normalized();
    off.tail<3>() = 10 * kDegree * Vec3(0.3, std::sin(index), std::cos(index)).normalized();
    StartGuess guess;
    guess.T_map_body = toMrpt(boxplus(truth, off));
    errors.add(matcher_->locate(scan, guess), truth);
  });
  errors.print();
  EXPECT_EQ(errors.accepted, errors.tried);
  EXPECT_LT(errors.worst, 0.15);
}

// Every 24th from nothing but which way is up.
TEST_F(RealScans, AreFoundInTheWholeMap) {
  Errors errors;
  forEveryNth(24, [&](int, const Scan& scan, const Pose& truth) {
    StartGuess guess;
    guess.up_body = truth.rotation.transpose() * Vec3::UnitZ();
    errors.add(matcher_->locate(scan, guess), truth);
  });
  errors.print();
  EXPECT_GE(errors.accepted, errors.tried - 1);
  EXPECT_LT(errors.worst, 0.15);
}

}  // namespace
}  // namespace paloc
