#include "paloc/core/constant_errors.h"

namespace paloc {
namespace {

using Covariances = ChainSolver::JointCovariances;

constexpr double kNegligible = 1e-4;  // of a variance

bool negligible(const StateVector& v, const StateMatrix& covariance) {
  return (v.array().square() < kNegligible * covariance.diagonal().array()).all();
}

// P D P. With P(k, l) = gains[k] P(k+1, l) for l > k, what lies at or before k acts on it as
// P(k, k) X(k) P(k, k), X(k) = gains[k-1]^T X(k-1) gains[k-1] + D(k); what lies after k as
// gains[k] F(k+1) gains[k]^T, F(k) the same sum over all from k on.
void takeAway(std::span<const Mat6> white, Covariances& p) {
  std::vector<StateMatrix> before(p.own.size());
  for (std::size_t k = 0; k < before.size(); ++k) {
    before[k].setZero();
    if (k > 0) before[k].noalias() = p.gains[k - 1].transpose() * (before[k - 1] * p.gains[k - 1]);
    before[k].topLeftCorner<6, 6>() += white[k];
  }
  StateMatrix after = StateMatrix::Zero();  // F(k+1)
  for (std::size_t k = before.size(); k-- > 0;) {
    const StateMatrix own = p.own[k];
    StateMatrix from_later = StateMatrix::Zero();
    const StateMatrix weighted = own * before[k];
    if (k + 1 < before.size()) {
      const StateMatrix crossed = p.gains[k] * after;
      p.with_next[k] -= crossed + weighted * p.with_next[k].eval();
      from_later.noalias() = crossed * p.gains[k].transpose();
    }
    const StateMatrix taken = from_later + weighted * own;
    p.own[k] -= 0.5 * (taken + taken.transpose());
    const auto pose = own.leftCols<6>();
    after = from_later + pose * (white[k] * pose.transpose());
  }
}

// One error, or a part of it that lies far from the rest.
class Stretch {
 public:
  Stretch(const std::vector<StateMatrix>& own, Covariances& result) : p_(own), result_(result) {}

  // Of the shares from `first` on, those that are near each other; returns the one after them.
  std::size_t add(const ConstantError& error, std::size_t first) {
    const std::size_t next = forward(error, first);
    backward(error, first, next);
    return next;
  }

 private:
  // What lies at or before a node acts on it as P(k, k) x(k), x(k) = gains[k-1]^T x(k-1) + u(k).
  std::size_t forward(const ConstantError& error, std::size_t share) {
    effect_.clear();
    StateVector x = StateVector::Zero();
    for (std::size_t k = error[share].node; k < p_.size(); ++k) {
      const bool acts = share < error.size() && error[share].node == k;
      if (acts) x.head<6>() += error[share++].gradient;
      effect_.push_back(p_[k] * x);
      if (!acts && negligible(effect_.back(), p_[k])) break;
      if (k + 1 < p_.size()) x = (result_.gains[k].transpose() * x).eval();
    }
    return share;
  }

  // What lies after it as gains[k] f(k+1), f(k) = P(k, k) u(k) + gains[k] f(k+1).
  void backward(const ConstantError& error, std::size_t first, std::size_t share) {
    const std::size_t begin = error[first].node, end = begin + effect_.size();
    StateVector after = StateVector::Zero(), effect_after = StateVector::Zero();
    for (std::size_t k = end; k-- > 0;) {
      StateVector later = StateVector::Zero();
      if (k + 1 < end) later.noalias() = result_.gains[k] * after;
      const StateVector effect = k < begin ? later : StateVector(effect_[k - begin] + later);
      result_.own[k].noalias() += effect * effect.transpose();
      if (k + 1 < end) result_.with_next[k].noalias() += effect * effect_after.transpose();
      if (k < begin && negligible(effect, p_[k])) return;
      effect_after = effect;
      after = later;
      if (share > first && error[share - 1].node == k) {
        after.noalias() += p_[k].leftCols<6>() * error[--share].gradient;
      }
    }
  }

  const std::vector<StateMatrix>& p_;  // A^-1
  Covariances& result_;
  std::vector<StateVector> effect_;  // of the stretch's nodes
};

}  // namespace

void considerConstantErrors(std::span<const Mat6> taken_as_white,
                            std::span<const ConstantError> errors, Covariances& covariances) {
  const std::vector<StateMatrix> own = covariances.own;
  takeAway(taken_as_white, covariances);
  Stretch stretch(own, covariances);
  for (const ConstantError& error : errors) {
    for (std::size_t share = 0; share < error.size();) share = stretch.add(error, share);
  }
}

}  // namespace paloc
