#include "paloc/tools/direction_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "paloc/core/mrpt_pose.h"

namespace paloc {
namespace {

using Lines = std::vector<std::string>;

/// Frames of ten a second, whose body turns by `yaw_step` a frame; the map's x and its yaw are
/// fixed or not.
class DirectionWatchTest : public testing::Test {
 protected:
  void go(int frames, DirectionClass along_map_x, DirectionClass yaw = DirectionClass::kFull,
          MatchRefusal refusal = MatchRefusal::kNone) {
    for (int i = 0; i < frames; ++i, ++frame_) {
      FrameDiagnostics f;
      f.t_ns = 1'700'000'000 * kNsPerSecond + frame_ * kNsPerSecond / 10;
      f.match.refusal = refusal;
      const Mat3 R = so3::exp(Vec3(0, 0, yaw_step_ * static_cast<double>(frame_)));
      f.match.T_map_body = toMrpt(Pose{Vec3::Zero(), R});
      for (std::size_t k = 0; k < 6; ++k) {
        const Vec3 axis_map = Vec3::Unit(static_cast<Eigen::Index>(k % 3));
        f.match.directions[k].axis_body = R.transpose() * axis_map;
        f.match.directions[k].cls = DirectionClass::kFull;
      }
      f.match.directions[0].cls = along_map_x;
      f.match.directions[5].cls = yaw;
      // The weakest comes first, whatever its sign.
      if (frame_ % 2 == 1) std::swap(f.match.directions[0], f.match.directions[1]);
      if (frame_ % 3 == 1) f.match.directions[1].axis_body *= -1;
      for (std::string& line : watch_.add(f)) told_.push_back(std::move(line));
    }
  }

  double yaw_step_ = 0;
  TimeNs frame_ = 0;
  DirectionWatch watch_;
  Lines told_;
};

TEST_F(DirectionWatchTest, TellsOnceWhatIsLostAndOnceWhenItIsBack) {
  yaw_step_ = 0.05;  // half a turn while it is lost
  go(50, DirectionClass::kFull);
  yaw_step_ = 0.05;
  go(60, DirectionClass::kNone);
  go(50, DirectionClass::kFull);
  ASSERT_EQ(told_.size(), 2U);
  EXPECT_EQ(told_[0].find("5.0 s: the map no longer fixes the position "), 0U) << told_[0];
  EXPECT_EQ(told_[1].find("10.9 s: the map fixes the position "), 0U) << told_[1];
  EXPECT_NE(told_[1].find("again, after 5.9 s"), std::string::npos) << told_[1];
}

TEST_F(DirectionWatchTest, NamesEachDirectionAndKindOnItsOwn) {
  go(10, DirectionClass::kFull);
  go(20, DirectionClass::kNone, DirectionClass::kPartial);
  go(20, DirectionClass::kNone);
  ASSERT_EQ(told_.size(), 3U);
  EXPECT_EQ(told_[0], "1.0 s: the map no longer fixes the position along body x (heading)");
  EXPECT_EQ(told_[1], "1.0 s: the map no longer fixes the rotation yaw");
  EXPECT_EQ(told_[2], "2.9 s: the map fixes the rotation yaw again, after 1.9 s");
}

TEST_F(DirectionWatchTest, IsSilentOnFlickerAndOnScansWithoutAMapFactor) {
  for (int i = 0; i < 20; ++i) {
    go(2, DirectionClass::kPartial);
    go(8, DirectionClass::kFull);
  }
  go(30, DirectionClass::kNone, DirectionClass::kNone, MatchRefusal::kLowOverlap);
  EXPECT_TRUE(told_.empty()) << told_.front();
}

TEST_F(DirectionWatchTest, ADirectionThatFlickersBackForAMomentStaysLost) {
  go(20, DirectionClass::kNone);
  for (int i = 0; i < 10; ++i) {
    go(2, DirectionClass::kFull);
    go(8, DirectionClass::kPartial);
  }
  EXPECT_EQ(told_.size(), 1U);
}

}  // namespace
}  // namespace paloc
