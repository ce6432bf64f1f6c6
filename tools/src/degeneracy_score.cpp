#include "paloc/tools/degeneracy_score.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace paloc {
namespace {

constexpr double kSameAxisDeg = 20;

double shareOf(std::size_t part, std::size_t whole) {
  return whole == 0 ? 1 : static_cast<double>(part) / static_cast<double>(whole);
}

/// The labelled directions of one kind, three axes that are orthogonal to each other.
class LabelledAxes {
 public:
  LabelledAxes(const LabelledDirections& labels, std::size_t first)
      : labels_(labels), first_(first) {}

  /// The square of the axis' projection onto all directions with a label.
  double projectionSq(const Vec3& axis, DirectionLabel label) const {
    double sum = 0;
    for (std::size_t i = first_; i < first_ + 3; ++i) {
      if (labels_.label[i] == label) sum += std::pow(axis.dot(labels_.axis_body[i]), 2);
    }
    return sum;
  }

  std::size_t count(DirectionLabel label) const {
    return static_cast<std::size_t>(std::count(labels_.label.begin() + long(first_),
                                               labels_.label.begin() + long(first_) + 3, label));
  }

  /// The label of what the axis mostly is.
  DirectionLabel dominant(const Vec3& axis) const {
    const double full = projectionSq(axis, DirectionLabel::kFull);
    const double weak = projectionSq(axis, DirectionLabel::kWeak);
    const double degenerate = projectionSq(axis, DirectionLabel::kDegenerate);
    if (full >= std::max(weak, degenerate)) return DirectionLabel::kFull;
    return weak >= degenerate ? DirectionLabel::kWeak : DirectionLabel::kDegenerate;
  }

 private:
  const LabelledDirections& labels_;
  std::size_t first_;
};

double angleDeg(double projection_sq) {
  return std::acos(std::sqrt(std::clamp(projection_sq, 0.0, 1.0))) * 180 / std::numbers::pi;
}

}  // namespace

void DegeneracyScore::add(const LabelledDirections& labels,
                          const std::array<MatchDirection, 6>& directions) {
  ++poses;
  for (const std::size_t first : {std::size_t{0}, std::size_t{3}}) {
    const LabelledAxes axes(labels, first);
    const std::size_t open = axes.count(DirectionLabel::kDegenerate);
    degenerate += open;
    full += axes.count(DirectionLabel::kFull);
    weak += axes.count(DirectionLabel::kWeak);
    std::vector<double> angles;  // of what is classed none, to the open directions
    for (std::size_t i = first; i < first + 3; ++i) {
      const MatchDirection& d = directions[i];
      const DirectionLabel label = axes.dominant(d.axis_body);
      if (d.cls == DirectionClass::kFull) {
        weak_called_full += label == DirectionLabel::kWeak ? 1 : 0;
        continue;
      }
      false_alarms += label == DirectionLabel::kFull ? 1 : 0;
      if (label != DirectionLabel::kDegenerate) continue;
      if (d.cls == DirectionClass::kPartial) {
        ++called_partial;
      } else {
        angles.push_back(angleDeg(axes.projectionSq(d.axis_body, DirectionLabel::kDegenerate)));
      }
    }
    std::sort(angles.begin(), angles.end());
    for (std::size_t i = 0; i < std::min(angles.size(), open); ++i) {
      if (angles[i] > kSameAxisDeg) continue;
      ++found;
      axis_errors_deg.push_back(angles[i]);
    }
  }
}

void DegeneracyScore::merge(const DegeneracyScore& other) {
  poses += other.poses;
  refused += other.refused;
  degenerate += other.degenerate;
  found += other.found;
  called_partial += other.called_partial;
  full += other.full;
  false_alarms += other.false_alarms;
  weak += other.weak;
  weak_called_full += other.weak_called_full;
  axis_errors_deg.insert(axis_errors_deg.end(), other.axis_errors_deg.begin(),
                         other.axis_errors_deg.end());
}

double DegeneracyScore::precision() const { return shareOf(found, found + false_alarms); }
double DegeneracyScore::recall() const { return shareOf(found, degenerate); }

double DegeneracyScore::f1() const { return shareOf(2 * found, found + false_alarms + degenerate); }

double DegeneracyScore::falseAlarmRate() const {
  return full == 0 ? 0 : static_cast<double>(false_alarms) / static_cast<double>(full);
}

}  // namespace paloc
