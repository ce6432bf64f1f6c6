#include "paloc/frontends/lio_calibration.h"

#include <gtest/gtest.h>

#include <random>

#include "box_world.h"
#include "paloc/frontends/calibration_block.h"
#include "paloc/frontends/lio_filter.h"
#include "paloc/frontends/place_points.h"
#include "walls.h"

namespace paloc {
namespace {

namespace lc = lio_calibration;

constexpr TimeNs kStart = 2 * kNsPerSecond, kEnd = kStart + 100'000'000;
constexpr double kDuration = 0.1;                    // s
const Vec3 kSensor(0.3, -0.1, 0.5);                  // m, body frame
const Vec3 kRate(0.3, -0.5, 1.2), kForce(1, -2, 9);  // rad/s, m/s2

ImuBuffer evenImu(const Vec3& rate, const Vec3& force) {
  ImuBuffer imu;
  for (TimeNs t = kStart - 50'000'000; t <= kEnd + 50'000'000; t += 2'500'000) {
    imu.add({t, force, rate});
  }
  return imu;
}

FreeFallScan scanOf(const ImuBuffer& imu, TimeNs later_ns = 0) {
  return {imu, kStart + later_ns, kEnd + later_ns, 0.05, Vec3::Zero(), Vec3::Zero()};
}

CalibratedLioState someState(const FreeFallScan& scan, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  CalibratedLioState s;
  s.x.T_odom_body = {10 * vector(), so3::exp(vector())};
  s.x.v_odom = vector();
  s.x.gravity_odom = so3::exp(0.4 * vector()) * s.x.gravity_odom;
  s.calibration = {so3::exp(0.02 * vector()), 0.05 * vector(), 0.002 * normal(random)};
  s.sensor = SensorMotion(scan, kSensor);
  return s;
}

std::vector<MeasuredPoint> somePoints(double age_s) {
  return {{Vec3(4, 1, 0.5), age_s}, {Vec3(-3, 5, -1), age_s}, {Vec3(1, -6, 2), age_s}};
}

std::vector<PlacedPoint> placed(const std::vector<MeasuredPoint>& points, const FreeFallScan& scan,
                                const CalibratedLioState& s) {
  std::vector<PlacedPoint> result;
  placePoints(points, scan, kSensor, s, 1, result);
  return result;
}

TEST(LioCalibration, BoxplusUndoesBoxminus) {
  const FreeFallScan scan = scanOf(evenImu(kRate, kForce));
  for (unsigned i = 0; i < 100; ++i) {
    const CalibratedLioState from = someState(scan, i), to = someState(scan, i + 1000);
    const CalibratedLioState back = boxplus(from, boxminus(to, from));
    EXPECT_LT(boxminus(back, to).norm(), 1e-9);
    EXPECT_TRUE((toLidar(from) * toLidar(from, -1)).isIdentity(1e-12));
  }
}

TEST(LioCalibration, TheScansMotionIsTheImus) {
  const FreeFallScan scan = scanOf(evenImu(kRate, kForce));
  EXPECT_LT((scan.meanRate() - kRate).norm(), 1e-9);
  const FreeFallScan straight = scanOf(evenImu(Vec3::Zero(), kForce));
  EXPECT_LT((straight.meanForce() - kForce).norm(), 1e-9);
  const Vec3 point(3, -2, 1);
  const double h = 1e-5, age_s = 0.0401;
  const Vec3 moved = (scan.place(point, age_s - h) - scan.place(point, age_s + h)) / (2 * h);
  EXPECT_LT((scan.velocity(point, age_s) - moved).norm(), 1e-6);
}

// What moves the points, against the derivative by what a scan measures and that by the state.
TEST(LioCalibration, JacobianIsThatOfThePoints) {
  const FreeFallScan scan = scanOf(evenImu(kRate, kForce));
  constexpr double kStep = 1e-5;
  for (const double age_s : {0.0, 0.5 * kDuration, kDuration}) {
    const auto points = somePoints(age_s);
    const CalibratedLioState s = someState(scan, 7);
    const auto at = placed(points, scan, s);
    const auto derivative = calibratedToMeasured(s);
    for (int k = 0; k < CalibratedLioState::kDim; ++k) {
      if (k >= lio::kBiasAcc && k < lio::kDim) continue;  // no scan is asked for these
      const CalibratedLioVector step = kStep * CalibratedLioVector::Unit(k);
      const auto plus = placed(points, scan, boxplus(s, step));
      const auto minus = placed(points, scan, boxplus(s, -step));
      // How the rotation bends the scan is left out, and the turn during the scan but to first
      // order: so much of the range, at half the scan's length from its middle.
      const bool turns = k >= lio::kDim && k < lio::kDim + lc::kPosition;
      const bool late = k == lio::kDim + lc::kTimeOffset;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const double range = at[i].lever.norm(), turn = 0.5 * kDuration * kRate.norm();
        const double tolerance = turns ? 1.2 * turn * range : late ? 2 * turn * turn * range : 0.02;
        for (int axis = 0; axis < 3; ++axis) {
          const PointToPlane row{Vec3::Unit(axis), at[i].lever, age_s, 0, 0};
          const Eigen::Matrix<double, 9, 1> measured = derivative.col(k);
          const double expected = jacobianOf<9>(row, 1).dot(measured);
          const double found = (plus[i].point_odom - minus[i].point_odom)[axis] / (2 * kStep);
          EXPECT_NEAR(found, expected, tolerance) << k << ' ' << age_s;
        }
      }
    }
  }
}

TEST(LioCalibration, JacobianIsExactWhereTheBodyDoesNotTurn) {
  const FreeFallScan scan = scanOf(evenImu(Vec3::Zero(), kForce));
  constexpr double kStep = 1e-5;
  for (const double age_s : {0.0, 0.03, kDuration}) {
    const auto points = somePoints(age_s);
    const CalibratedLioState s = someState(scan, 8);
    const auto at = placed(points, scan, s);
    const auto derivative = calibratedToMeasured(s);
    for (int k = lio::kDim; k < CalibratedLioState::kDim; ++k) {
      const CalibratedLioVector step = kStep * CalibratedLioVector::Unit(k);
      const auto plus = placed(points, scan, boxplus(s, step));
      const auto minus = placed(points, scan, boxplus(s, -step));
      // Within a slot of the scan the force moves the body evenly. Left out is what turns with the
      // LiDAR besides: where force and gravity have the body, tau before the end.
      const double fallen = 0.5 * (kForce.norm() + s.x.gravity_odom.norm()) * age_s * age_s;
      const bool late = k == lio::kDim + lc::kTimeOffset;
      const double tolerance = late ? 0.02 : 1e-4 + 1.1 * fallen;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 found = (plus[i].point_odom - minus[i].point_odom) / (2 * kStep);
        for (int axis = 0; axis < 3; ++axis) {
          const PointToPlane row{Vec3::Unit(axis), at[i].lever, age_s, 0, 0};
          const Eigen::Matrix<double, 9, 1> measured = derivative.col(k);
          EXPECT_NEAR(found[axis], jacobianOf<9>(row, 1).dot(measured), tolerance) << k;
        }
      }
    }
  }
}

// A scan h later by the IMU's clock: integrated anew, the state carried on to its end.
TEST(LioCalibration, TheTimeOffsetIsAnotherTimeOfTheImu) {
  const ImuBuffer imu = evenImu(kRate, kForce);
  const FreeFallScan scan = scanOf(imu);
  CalibratedLioState s = someState(scan, 9);
  constexpr TimeNs kLater = 1'000'000;
  for (const double age_s : {0.001, 0.05, 0.1}) {
    const auto points = somePoints(age_s);
    s.calibration.imu_late_s = 1e-3;
    const auto offset = placed(points, scan, s);
    CalibratedLioState later = s;
    later.calibration.imu_late_s = 0;
    later.x =
        predictLio(s.x, *imu.integrate(kEnd, kEnd + kLater, 0.05, {}, Vec3::Zero(), Vec3::Zero()));
    const auto anew = placed(points, scanOf(imu, kLater), later);
    s.calibration.imu_late_s = 0;
    const auto before = placed(points, scan, s);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3 moved = anew[i].point_odom - before[i].point_odom;
      EXPECT_GT(moved.norm(), 1e-3);
      EXPECT_LT((offset[i].point_odom - anew[i].point_odom).norm(), 0.02 * moved.norm());
    }
  }
}

TEST(LioCalibration, WhereTheBodyRestsItMovesNoPoint) {
  const FreeFallScan scan = scanOf(evenImu(Vec3::Zero(), Vec3(0, 0, 9.80665)));
  CalibratedLioState s = someState(scan, 10);
  s.x.v_odom.setZero();
  EXPECT_LT(calibratedToMeasured(s).topRightCorner(6, lc::kDim).norm(), 1e-12);
  s.x.T_odom_body.rotation = Mat3::Identity();
  s.x.gravity_odom = Vec3(0, 0, -9.80665);
  EXPECT_LT(calibratedToMeasured(s).rightCols<lc::kDim>().norm(), 1e-6);
}

FastLioSettings estimatingAll() {
  FastLioSettings settings;
  settings.estimate_extrinsic = settings.estimate_time_offset = true;
  return settings;
}

/// A filter in a room of three pairs of walls, with a map of them that hangs on the LiDAR; and the
/// body's poses, which turn about an axis and come back (no noise of the IMU).
class CalibratedFilter : public testing::Test {
 protected:
  CalibratedFilter() { filter_.calibrate(CalibrationBlock(estimatingAll())); }

  void begin(const test::Path& path) {
    path_ = path;
    add(0);
    LioState x;
    x.v_odom = velocity(0);
    x.T_odom_body = path_(0);
    filter_.begin(x, 1e-8 * LioMatrix::Identity(), kSensor, scanAt(0));
  }

  void track(int scans) {
    for (int i = 1; i <= scans; ++i) {
      const TimeNs from = (i - 1) * kStep, to = i * kStep;
      add(to);
      filter_.predict(*imu_.integrate(from, to, 0.05, {}, Vec3::Zero(), Vec3::Zero()), {});
      const FreeFallScan scan = scanAt(to);
      std::vector<MeasuredPoint> points = room_.points;
      const Pose T_body_odom = path_(seconds(to)).inverse();
      for (MeasuredPoint& p : points) p.point_body = T_body_odom * p.point_body;
      filter_.update(points, scan, kSensor, room_.map);
    }
  }

  CalibrationVector sigma() const {
    return filter_.calibration()->covariance.diagonal().cwiseSqrt();
  }

  LioFilter filter_{{}};

 private:
  static constexpr TimeNs kStep = 100'000'000, kDurationNs = 1'000'000;  // ns

  static double seconds(TimeNs t) { return static_cast<double>(t) * 1e-9; }
  Vec3 velocity(double t) const {
    return (path_(t + 1e-4).position - path_(t - 1e-4).position) / 2e-4;
  }
  void add(TimeNs until) {
    for (; next_ns_ <= until + 10'000'000; next_ns_ += 2'500'000) {
      imu_.add(test::imuOnPath(path_, next_ns_, 9.80665));
    }
  }
  // So short that its points have one time.
  FreeFallScan scanAt(TimeNs t) const {
    return {imu_, t - kDurationNs, t, 0.05, Vec3::Zero(), Vec3::Zero()};
  }

  test::Walls room_{{0, 1, 2}};
  test::Path path_;
  ImuBuffer imu_;
  TimeNs next_ns_ = -20'000'000;
};

TEST_F(CalibratedFilter, AtRestItStaysWithThePrior) {
  begin([](double) { return Pose{}; });
  const CalibrationVector prior = sigma();
  track(40);
  for (int k = 0; k < lc::kDim; ++k) EXPECT_GT(sigma()[k], 0.95 * prior[k]) << k;
}

TEST_F(CalibratedFilter, ATurnAboutOneAxisLeavesThePositionAlongItOpen) {
  begin([](double t) {
    return Pose{Vec3::Zero(), so3::exp(Vec3(0, 0, 0.6 * (1 - std::cos(1.5 * t))))};
  });
  const CalibrationVector prior = sigma();
  track(60);
  EXPECT_GT(sigma()[lc::kPosition + 2], 0.9 * prior[lc::kPosition + 2]);
  EXPECT_LT(sigma()[lc::kPosition], 0.2 * prior[lc::kPosition]);
  EXPECT_LT(sigma()[lc::kPosition + 1], 0.2 * prior[lc::kPosition + 1]);
  EXPECT_LT(sigma()[lc::kRotation], 0.1 * prior[lc::kRotation]);
  EXPECT_LT(sigma()[lc::kRotation + 1], 0.1 * prior[lc::kRotation + 1]);
  EXPECT_LT(sigma()[lc::kTimeOffset], 0.1 * prior[lc::kTimeOffset]);
}

TEST_F(CalibratedFilter, StampsTakeOverTheOffset) {
  CalibrationBlock block(estimatingAll());
  block.value.imu_late_s = 0.012;
  block.takeTimeOffset(0.01);
  EXPECT_NEAR(block.value.imu_late_s, 0.002, 1e-12);
  EXPECT_NEAR(block.imuLateS(), 0.012, 1e-12);
}

}  // namespace
}  // namespace paloc
