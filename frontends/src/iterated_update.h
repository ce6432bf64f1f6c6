#pragma once

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "paloc/frontends/plane_matches.h"

namespace paloc {

/// How far a point at a range of `lever_m` may be from where a state puts it (m): one sigma. Of any
/// state whose tangent space begins with [position (m), rotation (rad)].
template <int D>
double displacementSigma(const Eigen::Matrix<double, D, D>& covariance, double lever_m) {
  const double position = covariance.diagonal().template head<3>().sum();
  const double rotation = covariance.diagonal().template segment<3>(3).sum();
  return std::sqrt(position + lever_m * lever_m * rotation);
}

struct IterationLimits {
  int max_iterations = 20;
  double max_gate_m = 0.5;
};

/// The update of an iterated error-state Kalman filter with the points of a scan, each onto its
/// plane in a local map (W. Xu et al., "FAST-LIO2", 2022, section V-C). The state has D dimensions,
/// of which the scan measures N: those of PointToPlaneSums<N>.
///
/// What the scan does not tell is treated as S. F. Schmidt's consider states: it updates the rest
/// as if that along open directions were given, and leaves it as it was. Left in the equations, an
/// open position of large variance would follow from the smallest error of the direction that is
/// believed to be open.
template <class State, int D, int N>
class IteratedUpdate {
 public:
  using Vector = Eigen::Matrix<double, D, 1>;
  using Matrix = Eigen::Matrix<double, D, D>;
  using ToMeasured = Eigen::Matrix<double, N, D>;

  IteratedUpdate(const IterationLimits& limits, PlaneMatches& matches, const LocalVoxelMap& map,
                 double ageing)
      : limits_(limits), matches_(matches), map_(map), ageing_(ageing) {}

  /// `place(x)` gives the points where the state x puts them; `toMeasured(x)` is the derivative of
  /// the scan's directions by the state's. False if too few points have a plane: nothing is known.
  template <class Place, class Derivative>
  bool run(const State& prior, const Matrix& covariance, double lever_m, Place place,
           Derivative toMeasured) {
    state_ = prior;
    considerAll(covariance);
    const double deviation = displacementSigma<D>(covariance, lever_m);
    const double gate = std::min(limits_.max_gate_m, 3 * deviation + kLeastGate);
    double widening = std::min(deviation, gate);
    converged_ = false;
    std::optional<InformativePart<N>> informative;
    Matrix information = Matrix::Zero();
    for (int i = 0; i < limits_.max_iterations && !converged_; ++i) {
      matches_.associate(place(state_), map_, gate, kVoxelsOfWidening * widening);
      if (matches_.size() < kMinRows) return false;
      matches_.weigh(widening);
      const ToMeasured to_measured = toMeasured(state_);
      PointToPlaneSums<N> sums = matches_.template sums<N>(ageing_);
      if (widening > 0 || i == 0) {
        informative.emplace(sums.information, matches_.template normalNoise<N>(ageing_));
        considerOpen(covariance, to_measured.transpose() * informative->open());
        widening = std::min(widening, displacementSigma<D>(touched_, lever_m));
      }
      informative->apply(sums);
      information = to_measured.transpose() * sums.information * to_measured;
      const Vector gradient = to_measured.transpose() * sums.gradient;
      // (P^-1 + H) d = P^-1 (prior - x) - gradient, times P: no inverse of a covariance is needed.
      const Matrix system = Matrix::Identity() + touched_ * information;
      const Vector step =
          system.partialPivLu().solve(boxminus(prior, state_) - touched_ * gradient);
      if (!step.allFinite()) return false;
      state_ = boxplus(state_, step);
      converged_ = widening == 0 && step.template head<3>().norm() < kConvergedM &&
                   step.template segment<3>(3).norm() < kConvergedRad;
      widening = widening < kLeastWidening ? 0 : kNarrowing * widening;
    }
    system_.compute(Matrix::Identity() + touched_ * information);
    const Matrix updated = system_.solve(touched_) + (covariance - touched_);
    covariance_ = 0.5 * (updated + updated.transpose());
    return true;
  }

  // After run(), where it is true.
  const State& state() const { return state_; }
  const Matrix& covariance() const { return covariance_; }
  /// Whether the last step was small; if not, the state is what the limit of iterations left.
  bool converged() const { return converged_; }
  /// What the update makes of E[error of the state . some other error].
  template <class Cross>
  Cross updated(const Cross& cross) const {
    return system_.solve(cross - open_ * cross) + open_ * cross;
  }

 private:
  static constexpr double kLeastWidening = 0.01, kNarrowing = 0.3;  // m; a step
  static constexpr double kVoxelsOfWidening = 1.5;                  // while the pose is not sure
  static constexpr double kLeastGate = 0.1;                         // m
  static constexpr double kConvergedM = 3e-4, kConvergedRad = 1e-4;
  static constexpr std::size_t kMinRows = 20;

  void considerAll(const Matrix& covariance) {
    open_.setZero();
    touched_ = covariance;
  }

  // What of an error goes with the error along open directions E (D x k), as a matrix:
  // P E (E^T P E)^-1 E^T; and the covariance without it.
  template <class Columns>
  void considerOpen(const Matrix& P, const Columns& E) {
    if (E.cols() == 0) return considerAll(P);
    const Eigen::Matrix<double, D, Eigen::Dynamic> PE = P * E;
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> along(E.transpose() * PE);
    open_ = PE * along.pseudoInverse() * E.transpose();
    const Matrix rest = P - open_ * P;
    touched_ = 0.5 * (rest + rest.transpose());
  }

  IterationLimits limits_;
  PlaneMatches& matches_;
  const LocalVoxelMap& map_;
  double ageing_;
  bool converged_ = false;
  State state_;
  Matrix covariance_ = Matrix::Zero();
  Matrix open_ = Matrix::Zero(), touched_ = Matrix::Zero();
  Eigen::PartialPivLU<Matrix> system_;
};

}  // namespace paloc
