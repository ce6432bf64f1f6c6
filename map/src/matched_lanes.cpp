#include "matched_lanes.h"

#include <algorithm>
#include <array>

#include "parallel_chunks.h"

namespace paloc {
namespace {

constexpr std::size_t kChunk = 256;  // fours of points: smaller ones take longer to hand over
// So many times four points are summed in single precision.
constexpr std::size_t kRun = 16;

/// The normal equations, lane by lane.
struct Sums {
  std::array<Float4, 21> upper{};
  std::array<Float4, 6> gradient{};

  void add(const Float4 (&j)[6], const Float4& residual, const Float4& weight) {
    std::size_t at = 0;
    for (std::size_t row = 0; row < 6; ++row) {
      const Float4 weighted = weight * j[row];
      for (std::size_t column = row; column < 6; ++column) upper[at++] += weighted * j[column];
      gradient[row] += weighted * residual;
    }
  }

  void addTo(NormalEquations& equations) const {
    std::size_t at = 0;
    for (int row = 0; row < 6; ++row) {
      for (int column = row; column < 6; ++column) {
        equations.information(row, column) += static_cast<double>(sumOf(upper[at++]));
      }
      equations.gradient[row] +=
          static_cast<double>(sumOf(gradient[static_cast<std::size_t>(row)]));
    }
  }
};

// R v.
void turn(const Eigen::Matrix3f& R, const Float4 (&v)[3], Float4 (&turned)[3]) {
  for (int i = 0; i < 3; ++i) turned[i] = R(i, 0) * v[0] + R(i, 1) * v[1] + R(i, 2) * v[2];
}

}  // namespace

void MatchedLanes::reset(std::size_t size, const Pose& reference) {
  size_ = size;
  reference_ = reference;
  turned_ = Mat3::Identity();
  lanes_.resize((size + 3) / 4);
  if (size % 4 == 0) return;
  // Lanes that are none have no normal and add nothing.
  lanes_.back() = Lanes{};
  lanes_.back().variance = all4(1);
}

void MatchedLanes::set(std::size_t i, const Vec3& point, const Vec3& normal, double residual,
                       double variance) {
  Lanes& lanes = lanes_[i / 4];
  const std::size_t lane = i % 4;
  for (int axis = 0; axis < 3; ++axis) {
    lanes.point[axis][lane] = static_cast<float>(point[axis]);
    lanes.normal[axis][lane] = static_cast<float>(normal[axis]);
  }
  lanes.at_reference[lane] = lanes.residual[lane] = static_cast<float>(residual);
  lanes.variance[lane] = static_cast<float>(variance);
}

// With the motion (Q, d) of the body since the reference pose, r = r_0 + n . ((Q - I) p + d).
void MatchedLanes::moveTo(const Pose& pose) {
  const Mat3 to_reference = reference_.rotation.transpose();
  turned_ = to_reference * pose.rotation;
  const Vec3 d = to_reference * (pose.position - reference_.position);
  const Eigen::Matrix3f turn_less = (turned_ - Mat3::Identity()).cast<float>();
  const Eigen::Vector3f moved = d.cast<float>();
  for (Lanes& lanes : lanes_) {
    Float4 by[3];
    turn(turn_less, lanes.point, by);
    lanes.residual = lanes.at_reference + lanes.normal[0] * (by[0] + moved.x()) +
                     lanes.normal[1] * (by[1] + moved.y()) + lanes.normal[2] * (by[2] + moved.z());
  }
}

NormalEquations MatchedLanes::equationsOf(std::size_t begin, std::size_t end, float kernel_sq,
                                          float scale_sq, float widening_sq) const {
  const Eigen::Matrix3f to_body = turned_.transpose().cast<float>();
  NormalEquations equations;
  for (std::size_t run = begin; run < end; run += kRun) {
    Sums sums;
    for (std::size_t i = run; i < std::min(end, run + kRun); ++i) {
      const Lanes& lanes = lanes_[i];
      const Float4 variance = scale_sq * lanes.variance, r = lanes.residual;
      const Float4 root = 1 + r * r / (kernel_sq * (variance + widening_sq));
      const Float4 weight = 1 / (root * root * variance);
      Float4 n[3];
      turn(to_body, lanes.normal, n);
      const auto& [px, py, pz] = lanes.point;
      sums.add(
          {n[0], n[1], n[2], py * n[2] - pz * n[1], pz * n[0] - px * n[2], px * n[1] - py * n[0]},
          r, weight);
    }
    sums.addTo(equations);
  }
  return equations;
}

NormalEquations MatchedLanes::equations(double kernel, double scale, double widening_m,
                                        tbb::task_arena& arena) const {
  const auto square = [](double value) { return static_cast<float>(value * value); };
  std::vector<NormalEquations> parts(chunkCount(lanes_.size(), kChunk));
  forEachChunk(
      arena, lanes_.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        parts[chunk] = equationsOf(begin, end, square(kernel), square(scale), square(widening_m));
      });
  NormalEquations sum;
  for (const NormalEquations& part : parts) {
    sum.information += part.information;
    sum.gradient += part.gradient;
  }
  sum.information = sum.information.selfadjointView<Eigen::Upper>().toDenseMatrix();
  return sum;
}

}  // namespace paloc
