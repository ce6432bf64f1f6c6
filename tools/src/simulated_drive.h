#pragma once

#include <deque>
#include <random>

#include "paloc/core/state.h"
#include "paloc/tools/smoother_problem.h"

namespace paloc {

/// An endless drive within some metres of the map's origin, as nodes of a smoother problem: a node
/// each 0.1 s, IMU at 200 Hz, an odometry and a map measurement at most nodes, and the trouble that
/// a long life brings. Made one by one, so that its length costs no memory.
///
/// Trouble: one odometry of 20 and one map measurement of 10 are missing; one of 20 comes half a
/// second late, one of 10,000 a minute late; one of 10,000 is not a number; and for 20 s of every
/// 300 there is no map at all.
class SimulatedDrive {
 public:
  explicit SimulatedDrive(unsigned seed);

  SmootherProblem::Node next();
  const ImuNoise& noise() const { return noise_; }

 private:
  void move(SmootherProblem::Node& node);
  void measureMotion(const Pose& before, SmootherProblem::Node& node);
  void measureMap(SmootherProblem::Node& node);
  SmootherProblem::MapMeasurement mapOf(std::size_t node, const Pose& truth);
  Vec3 noise(double sigma);
  bool oneOf(int many);

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  ImuNoise noise_;
  State truth_;
  Vec3 omega_body_ = Vec3::Zero();
  TimeNs t_ns_ = 0;
  std::size_t nodes_ = 0;
  std::deque<Pose> recent_;  // true poses of the last nodes, newest last
};

}  // namespace paloc
