#include "simulated_drive.h"

#include <cmath>
#include <limits>

#include "paloc/core/imu_factor.h"

namespace paloc {
namespace {

constexpr double kGravity_mps2 = 9.81;  // of smoother problems
constexpr int kSamplesPerNode = 20;
constexpr TimeNs kSample_ns = 5'000'000;
constexpr double kOdometrySigma_m = 0.01, kOdometrySigma_rad = 0.002;
constexpr double kMapSigma_m = 0.02, kMapSigma_rad = 0.004;
constexpr std::size_t kLate = 5, kTooLate = 600;  // nodes
constexpr std::size_t kPeriod = 3000, kWithoutMap = 200;

Mat6 diagonal(double position_sq, double rotation_sq) {
  Vec6 values;
  values << Vec3::Constant(position_sq), Vec3::Constant(rotation_sq);
  return values.asDiagonal();
}

}  // namespace

SimulatedDrive::SimulatedDrive(unsigned seed) : random_(seed) {
  truth_.bias_acc = noise(0.05);
  truth_.bias_gyro = noise(0.005);
}

Vec3 SimulatedDrive::noise(double sigma) {
  const double x = normal_(random_), y = normal_(random_), z = normal_(random_);
  return sigma * Vec3(x, y, z);
}

bool SimulatedDrive::oneOf(int many) {
  return std::uniform_int_distribution<int>(1, many)(random_) == 1;
}

SmootherProblem::Node SimulatedDrive::next() {
  SmootherProblem::Node node;
  const Pose before = truth_.T_map_body;
  if (nodes_ > 0) {
    move(node);
    if (!oneOf(20)) measureMotion(before, node);
  }
  node.t_ns = t_ns_;
  node.T_map_body_true = truth_.T_map_body;
  node.v_map_true = truth_.v_map;
  recent_.push_back(truth_.T_map_body);
  if (recent_.size() > kTooLate + 1) recent_.pop_front();
  measureMap(node);
  ++nodes_;
  return node;
}

// A node ahead: force and rate of one size through it, so that the truth is known exactly. A spring
// and friction keep the drive near the origin.
void SimulatedDrive::move(SmootherProblem::Node& node) {
  const Vec3 acceleration_map = -0.1 * truth_.T_map_body.position - 0.3 * truth_.v_map + noise(0.7);
  omega_body_ = 0.8 * omega_body_ + noise(0.15);
  const Vec3 force_body = truth_.T_map_body.rotation.transpose() *
                          (acceleration_map - kGravity_mps2 * truth_.gravity_map);
  const double step_s = 1e-9 * static_cast<double>(kSample_ns);
  const double acc_sigma = noise_.accelerometer_noise_density_mps2_sqrthz / std::sqrt(step_s);
  const double gyro_sigma = noise_.gyroscope_noise_density_radps_sqrthz / std::sqrt(step_s);
  // A step of Preintegration has the force turn with the body; a sample's holds in the frame in
  // which it begins (see problem_nodes.cpp).
  const Vec3 turning = so3::rightJacobianInverse(-step_s * omega_body_) * force_body;
  Preintegration exact(noise_, truth_.bias_acc, truth_.bias_gyro);
  for (int k = 0; k < kSamplesPerNode; ++k) {
    exact.integrate(turning + truth_.bias_acc, omega_body_ + truth_.bias_gyro, step_s);
    node.imu.push_back({t_ns_, force_body + truth_.bias_acc + noise(acc_sigma),
                        omega_body_ + truth_.bias_gyro + noise(gyro_sigma)});
    t_ns_ += kSample_ns;
  }
  truth_ = ImuFactor(exact, kGravity_mps2).predict(truth_);
  const double root_s = std::sqrt(step_s * kSamplesPerNode);
  truth_.bias_acc += noise(noise_.accelerometer_bias_walk_mps3_sqrthz * root_s);
  truth_.bias_gyro += noise(noise_.gyroscope_bias_walk_radps2_sqrthz * root_s);
}

void SimulatedDrive::measureMotion(const Pose& before, SmootherProblem::Node& node) {
  Vec6 error;
  error << noise(kOdometrySigma_m), noise(kOdometrySigma_rad);
  node.odometry.push_back(
      {boxplus(before.inverse() * truth_.T_map_body, error),
       diagonal(kOdometrySigma_m * kOdometrySigma_m, kOdometrySigma_rad * kOdometrySigma_rad)});
}

void SimulatedDrive::measureMap(SmootherProblem::Node& node) {
  const auto measureBehind = [&](std::size_t behind) {
    if (behind < recent_.size()) {
      node.map.push_back(mapOf(nodes_ - behind, recent_[recent_.size() - 1 - behind]));
    }
  };
  const bool without_map = nodes_ % kPeriod >= kPeriod - kWithoutMap;
  const bool missing = oneOf(10), late = oneOf(20), too_late = oneOf(10000), broken = oneOf(10000);
  if (!without_map && !missing) {
    measureBehind(0);
    if (broken) {
      node.map.back().T_map_body.position.x() = std::numeric_limits<double>::quiet_NaN();
    }
  }
  if (!without_map && late) measureBehind(kLate);
  if (too_late) measureBehind(kTooLate);
}

SmootherProblem::MapMeasurement SimulatedDrive::mapOf(std::size_t node, const Pose& truth) {
  Vec6 error;
  error << noise(kMapSigma_m), noise(kMapSigma_rad);
  return {node, boxplus(truth, error),
          diagonal(1 / (kMapSigma_m * kMapSigma_m), 1 / (kMapSigma_rad * kMapSigma_rad))};
}

}  // namespace paloc
