#include "paloc/tools/degeneracy_labels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "paloc/tools/degeneracy_score.h"

namespace paloc {
namespace {

/// A grid of exact points on a plane that is square to an axis of the body, turned by R.
void addPlane(std::vector<ExactPoint>& points, int axis, double at, double half, const Mat3& R) {
  for (double a = -half; a <= half; a += 0.25) {
    for (double b = -half; b <= half; b += 0.25) {
      Vec3 p;
      p[axis] = at;
      p[(axis + 1) % 3] = a;
      p[(axis + 2) % 3] = b;
      points.push_back({R * p, R * Vec3::Unit(axis)});
    }
  }
}

std::vector<ExactPoint> corridor(const Mat3& R) {
  std::vector<ExactPoint> points;
  for (const double side : {-1.5, 1.5}) {
    addPlane(points, 1, side, 5, R);
    addPlane(points, 2, side, 5, R);
  }
  return points;
}

TEST(DegeneracyLabels, OfACorridorOnlyItsAxisIsOpen) {
  for (const double yaw : {0.0, 0.5, 0.785}) {
    const Mat3 R = so3::exp(Vec3(0.1, -0.05, yaw));
    const LabelledDirections labels = labelDirections(corridor(R), 0.03);
    EXPECT_EQ(labels.label[0], DirectionLabel::kDegenerate);
    EXPECT_NEAR(std::abs(labels.axis_body[0].dot(R * Vec3::UnitX())), 1, 1e-9);
    EXPECT_TRUE(std::isinf(labels.sigma[0]));
    for (std::size_t i = 1; i < 6; ++i) EXPECT_EQ(labels.label[i], DirectionLabel::kFull) << i;
  }
}

TEST(DegeneracyLabels, AFewPointsMakeADirectionWeakAndMoreMakeItFull) {
  std::vector<ExactPoint> points = corridor(Mat3::Identity());
  // n points at 3 cm fix the axis to 3 cm / sqrt(n).
  points.push_back({Vec3(10, 0.1, 0.1), Vec3::UnitX()});
  EXPECT_NEAR(labelDirections(points, 0.03).sigma[0], 0.03, 1e-4);
  EXPECT_EQ(labelDirections(points, 0.03).label[0], DirectionLabel::kWeak);
  EXPECT_EQ(labelDirections(points, 0.06).label[0], DirectionLabel::kDegenerate);
  for (int i = 0; i < 20; ++i) points.push_back({Vec3(10, 0.1, 0.1), Vec3::UnitX()});
  EXPECT_EQ(labelDirections(points, 0.03).label[0], DirectionLabel::kFull);
}

TEST(DegeneracyLabels, ARoundRoomLeavesYawOpen) {
  std::vector<ExactPoint> points;
  addPlane(points, 2, -1.5, 3, Mat3::Identity());
  for (double a = 0; a < 6.28; a += 0.02) {
    const Vec3 out(std::cos(a), std::sin(a), 0);
    points.push_back({5 * out + Vec3(2, 0, 0), out});
  }
  const LabelledDirections labels = labelDirections(points, 0.03);
  EXPECT_EQ(labels.label[3], DirectionLabel::kDegenerate);
  EXPECT_NEAR(std::abs(labels.axis_body[3].z()), 1, 1e-6);
  // Seen 2 m off the middle, turning moves sideways.
  EXPECT_EQ(labels.label[0], DirectionLabel::kDegenerate);
  EXPECT_NEAR(std::abs(labels.axis_body[0].y()), 1, 1e-6);
  EXPECT_EQ(labels.label[1], DirectionLabel::kFull);
  EXPECT_EQ(labels.label[4], DirectionLabel::kFull);
}

class Score : public testing::Test {
 protected:
  void SetUp() override {
    labels_ = labelDirections(corridor(Mat3::Identity()), 0.03);
    for (std::size_t i = 0; i < 6; ++i) {
      directions_[i].axis_body = Vec3::Unit(static_cast<Eigen::Index>(i % 3));
      directions_[i].cls = DirectionClass::kFull;
    }
  }
  DegeneracyScore score() const {
    DegeneracyScore score;
    score.add(labels_, directions_);
    return score;
  }

  LabelledDirections labels_;
  std::array<MatchDirection, 6> directions_;
};

TEST_F(Score, CountsWhatIsFoundWithItsAxis) {
  directions_[0].cls = DirectionClass::kNone;
  directions_[0].axis_body = so3::exp(Vec3(0, 0, 0.0349)) * Vec3::UnitX();
  const DegeneracyScore s = score();
  EXPECT_EQ(s.degenerate, 1U);
  EXPECT_EQ(s.full, 5U);
  EXPECT_EQ(s.f1(), 1);
  ASSERT_EQ(s.axis_errors_deg.size(), 1U);
  EXPECT_NEAR(s.axis_errors_deg[0], 2, 0.01);
}

TEST_F(Score, PartialFindsNothingAndAlarmsFalsely) {
  directions_[0].cls = DirectionClass::kPartial;
  directions_[2].cls = DirectionClass::kPartial;
  const DegeneracyScore s = score();
  EXPECT_EQ(s.recall(), 0);
  EXPECT_EQ(s.called_partial, 1U);
  EXPECT_EQ(s.false_alarms, 1U);
  EXPECT_NEAR(s.falseAlarmRate(), 0.2, 1e-12);
}

TEST_F(Score, AWrongAxisIsBothAMissAndAFalseAlarm) {
  directions_[1].cls = DirectionClass::kNone;
  const DegeneracyScore s = score();
  EXPECT_EQ(s.found, 0U);
  EXPECT_EQ(s.false_alarms, 1U);
  EXPECT_EQ(s.f1(), 0);
}

}  // namespace
}  // namespace paloc
