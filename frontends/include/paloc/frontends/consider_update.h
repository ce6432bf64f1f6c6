#pragma once

#include <Eigen/LU>
#include <Eigen/QR>

namespace paloc {

/// The update of a Kalman filter, in information form, that leaves the estimate as it is along some
/// directions E (D x k): S. F. Schmidt's consider states ("Application of State-Space Methods to
/// Navigation Problems", 1966). What is not told of them still counts where it goes with an error
/// that is measured.
///
/// With P the covariance before, Pi the projector on what is across E, T = Pi P Pi, W the
/// information of a measurement H x + n and A = 1 + T W, an error e becomes
/// A^-1 (e + T H^T R^-1 n), however errors along E go with those across it. So the covariance is
/// Joseph's, A^-1 (P + T W T) A^-T.
template <int D>
class ConsiderUpdate {
 public:
  using Vector = Eigen::Matrix<double, D, 1>;
  using Matrix = Eigen::Matrix<double, D, D>;
  using Directions = Eigen::Matrix<double, D, Eigen::Dynamic, 0, D, D>;

  /// `covariance` is P, `considered` is E, of which the columns need not be orthonormal.
  void begin(const Matrix& covariance, const Directions& considered) {
    before_ = covariance;
    touched_ = covariance;
    if (considered.cols() == 0) return;
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> along(considered);
    project(considered * along.pseudoInverse());
  }

  /// The same where what is across E is not orthogonal to it, but what the rows of `along` (k x D),
  /// with along E = 1, do not see.
  void begin(const Matrix& covariance, const Directions& considered,
             const Eigen::Ref<const Eigen::MatrixXd>& along) {
    before_ = covariance;
    touched_ = covariance;
    if (considered.cols() > 0) project(considered * along);
  }

  /// Takes the measurement's information W, which is to be zero along E.
  void measure(const Matrix& information) {
    information_ = information;
    system_.compute(Matrix::Identity() + touched_ * information_);
  }

  /// T: what of the covariance the measurement changes.
  const Matrix& touched() const { return touched_; }

  /// The step from a state that is `off` (across E) from the prior's mean, where half the squared
  /// residuals have this gradient.
  Vector step(const Vector& off, const Vector& gradient) const {
    return system_.solve(-off - touched_ * gradient);
  }
  Matrix covariance() const {
    const Matrix sum = before_ + touched_ * information_ * touched_;
    const Matrix right = system_.solve(sum).transpose();
    const Matrix updated = system_.solve(right);
    return 0.5 * (updated + updated.transpose());
  }
  /// Of the step, from the prior's mean.
  Matrix gained() const { return system_.solve(touched_ * information_ * touched_); }
  /// What the update makes of E[error of the state . some other error].
  template <class Cross>
  Cross updated(const Cross& cross) const {
    return system_.solve(cross);
  }

 private:
  void project(const Matrix& along) {
    const Matrix across = Matrix::Identity() - along;
    const Matrix rest = across * before_ * across.transpose();
    touched_ = 0.5 * (rest + rest.transpose());
  }

  Matrix before_ = Matrix::Zero(), touched_ = Matrix::Zero(), information_ = Matrix::Zero();
  Eigen::PartialPivLU<Matrix> system_;
};

}  // namespace paloc
