#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "paloc/frontends/consider_update.h"
#include "paloc/frontends/point_to_plane_sums.h"

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
  /// A step that is so small in the sigmas of the result settles it, too; 0: only one that is small
  /// in itself.
  double settled_sigmas = 0;
};

/// The update of an iterated error-state Kalman filter with the points of a scan, each onto its
/// plane or line in a local map (W. Xu et al., "FAST-LIO2", 2022, section V-C). The state has D
/// dimensions, of which the scan measures N: those of PointToPlaneSums<N>.
///
/// Along the directions that the scan leaves open the state is considered, not estimated (see
/// ConsiderUpdate): an open position of large variance would follow from the smallest error of the
/// direction that is believed to be open.
///
/// Of the state's dimensions the first M are what scans alone can tell; the others (a calibration)
/// may move what is measured as well. Where a direction is open, what is measured stays as it is
/// along it, whichever of them moves it.
template <class State, int D, int N, int M = D>
class IteratedUpdate {
 public:
  using Vector = Eigen::Matrix<double, D, 1>;
  using Matrix = Eigen::Matrix<double, D, D>;
  using ToMeasured = Eigen::Matrix<double, N, D>;
  using Directions = typename ConsiderUpdate<D>::Directions;

  explicit IteratedUpdate(const IterationLimits& limits) : limits_(limits) {}
  /// From now on, dimensions of the state beyond those that scans alone can tell are left as they
  /// are.
  void considerRest() { consider_rest_ = true; }

  /// `matches` is asked, at each state x: associate(x, gate_m, least_voxel_m), size(),
  /// weigh(widening_m), sums() and normalNoise(), as of PlaneMatches. `toMeasured(x)` is the
  /// derivative of the scan's directions by the state's. False if too few points have a match:
  /// nothing is known.
  template <class Matches, class Derivative>
  bool run(const State& prior, const Matrix& covariance, double lever_m, Matches& matches,
           Derivative toMeasured) {
    state_ = prior;
    const double deviation = displacementSigma<D>(covariance, lever_m);
    const double gate = std::min(limits_.max_gate_m, 3 * deviation + kLeastGate);
    double widening = std::min(deviation, gate);
    converged_ = false;
    int sharp = 0;
    std::optional<InformativePart<N>> informative;
    information_.setZero();
    for (int i = 0; i < limits_.max_iterations && !converged_; ++i) {
      matches.associate(state_, gate, kVoxelsOfWidening * widening);
      if (matches.size() < kMinRows) return false;
      matches.weigh(widening);
      const ToMeasured to_measured = toMeasured(state_);
      PointToPlaneSums<N> sums = matches.sums();
      if (widening > 0 || i == 0) {
        informative.emplace(sums.information, matches.normalNoise());
        consider(covariance, to_measured, informative->open());
        widening = std::min(widening, displacementSigma<D>(update_.touched(), lever_m));
      }
      informative->apply(sums);
      information_ = to_measured.transpose() * sums.information * to_measured;
      const Vector gradient = to_measured.transpose() * sums.gradient;
      update_.measure(information_);
      const Vector step = update_.step(-boxminus(prior, state_), gradient);
      if (!step.allFinite()) return false;
      state_ = boxplus(state_, step);
      gradient_ = gradient + information_ * step;
      if (widening == 0) converged_ = isSmall(step) || (++sharp >= kLeastSharp && isSure(step));
      widening = widening < kLeastWidening ? 0 : kNarrowing * widening;
    }
    covariance_ = update_.covariance();
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
    return update_.updated(cross);
  }

  /// The covariance of the step from the prior to state().
  Matrix gained() const { return update_.gained(); }

  /// What the scan told, linearized at state(): its information, the gradient there of half the
  /// squared residuals, and the directions that it leaves open.
  const Matrix& information() const { return information_; }
  const Vector& gradient() const { return gradient_; }
  const Directions& open() const { return open_; }

 private:
  // Directions `open` of what the scan measures.
  void consider(const Matrix& covariance, const ToMeasured& to_measured,
                const NullDirections<N>& open) {
    if constexpr (M == D) {
      open_ = to_measured.transpose() * open;
      update_.begin(covariance, open_);
    } else {
      constexpr int kRest = D - M;
      const Eigen::Index k = open.cols(), rest = consider_rest_ ? kRest : 0;
      open_.setZero(D, k);
      open_.template topRows<M>() = to_measured.template leftCols<M>().transpose() * open;
      Eigen::MatrixXd along = Eigen::MatrixXd::Zero(k + rest, D);
      along.topRows(k) = open.transpose() * to_measured;
      Directions considered = Directions::Zero(D, k + rest);
      considered.leftCols(k) = open_;
      if (rest > 0) {
        along.topRightCorner(k, kRest).setZero();
        along.bottomRightCorner(kRest, kRest).setIdentity();
        considered.bottomRightCorner(kRest, kRest).setIdentity();
      }
      update_.begin(covariance, considered, along);
    }
  }
  static bool isSmall(const Vector& step) {
    return step.template head<3>().norm() < kConvergedM &&
           step.template segment<3>(3).norm() < kConvergedRad;
  }
  bool isSure(const Vector& step) const {
    const double sigmas = limits_.settled_sigmas;
    return sigmas > 0 && step.dot(update_.covariance().ldlt().solve(step)) < sigmas * sigmas;
  }

  static constexpr double kLeastWidening = 0.01, kNarrowing = 0.3;  // m; a step
  static constexpr double kVoxelsOfWidening = 1.5;                  // while the pose is not sure
  static constexpr double kLeastGate = 0.1;                         // m
  static constexpr double kConvergedM = 3e-4, kConvergedRad = 1e-4;
  static constexpr std::size_t kMinRows = 20;
  static constexpr int kLeastSharp = 5;  // steps without widening, before sigmas may settle it

  IterationLimits limits_;
  bool consider_rest_ = false;
  bool converged_ = false;
  State state_;
  Matrix covariance_ = Matrix::Zero();
  Matrix information_ = Matrix::Zero();
  Vector gradient_ = Vector::Zero();
  Directions open_{D, 0};
  ConsiderUpdate<D> update_;
};

}  // namespace paloc
