#include "paloc/tools/synth_people.h"

#include <algorithm>
#include <cmath>

namespace paloc::synth {
namespace {

constexpr double kAhead = 2.5, kBehind = 1.8;      // m along the way
constexpr double kBeside = 0.5;                    // m to the left of it
constexpr double kPiece = 8, kWalkingSpeed = 1.2;  // m, m/s: to and fro
constexpr double kKnotDistance = 0.05;             // m

// Where the way turns back, its left side jumps to the other: people go round in half a second.
WalkingPeople::Track smoothed(const WalkingPeople::Track& track) {
  constexpr std::size_t kReach = 10;  // steps to each side
  WalkingPeople::Track smooth;
  for (std::size_t i = 0; i < track.size(); ++i) {
    const std::size_t from = i < kReach ? 0 : i - kReach;
    const std::size_t to = std::min(i + kReach + 1, track.size());
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = from; k < to; ++k) sum += track[k];
    smooth.push_back(sum / static_cast<double>(to - from));
  }
  return smooth;
}

/// The way of the body over the floor, by its length.
class Way {
 public:
  Way(const Motion& motion, std::size_t steps) {
    for (std::size_t i = 0; i < steps; ++i) {
      const Vec3 p =
          motion
              .at(motion.startNs() + nsFromSeconds(static_cast<double>(i) * WalkingPeople::kStep_s))
              .T_map_body.position;
      if (knots_.empty()) {
        knots_.push_back(p);
        lengths_.push_back(0);
      } else if (const double step = (p - knots_.back()).head<2>().norm(); step > kKnotDistance) {
        lengths_.push_back(lengths_.back() + step);
        knots_.push_back(p);
      }
      length_at_.push_back(lengths_.back());
    }
  }

  double length() const { return lengths_.back(); }
  double lengthAt(std::size_t step) const { return length_at_[step]; }
  /// Held beyond the ends.
  Vec3 at(double s) const {
    const auto next = std::upper_bound(lengths_.begin(), lengths_.end(), s) - lengths_.begin();
    if (next == 0) return knots_.front();
    const auto i = static_cast<std::size_t>(next);
    if (i == knots_.size()) return knots_.back();
    const double share = (s - lengths_[i - 1]) / (lengths_[i] - lengths_[i - 1]);
    return knots_[i - 1] + share * (knots_[i] - knots_[i - 1]);
  }
  Vec3 leftOf(double s) const {
    const Vec3 ahead = at(s + 0.4) - at(s - 0.4);
    const double norm = ahead.head<2>().norm();
    return norm < 1e-6 ? Vec3::UnitY() : Vec3(-ahead.y() / norm, ahead.x() / norm, 0);
  }

 private:
  std::vector<Vec3> knots_;
  std::vector<double> lengths_, length_at_;
};

Vec3 onTheFloor(const Vec3& p, const Raycaster& scene) {
  const Eigen::Vector3f down = -Eigen::Vector3f::UnitZ();
  RayHit hit;
  scene.cast(p, {&down, 1}, {&hit, 1});
  return p - Vec3(0, 0, hit.valid() ? static_cast<double>(hit.distance_m) : 0);
}

// Distance along the ray (unit direction) to an upright cylinder's side, infinite if it is missed.
double toCylinder(const Vec3& from, const Vec3& d, const Vec3& foot, double radius, double height) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const Vec3 o = from - foot;
  const double a = d.head<2>().squaredNorm(), b = o.head<2>().dot(d.head<2>());
  const double c = o.head<2>().squaredNorm() - radius * radius;
  const double root_sq = b * b - a * c;
  if (a < 1e-12 || root_sq < 0 || c < 0) return kNever;  // from inside nothing is seen
  const double along = (-b - std::sqrt(root_sq)) / a;
  const double z = o.z() + along * d.z();
  return along > 0 && z > 0 && z < height ? along : kNever;
}

double toBall(const Vec3& from, const Vec3& d, const Vec3& middle, double radius) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const Vec3 o = from - middle;
  const double b = o.dot(d), c = o.squaredNorm() - radius * radius, root_sq = b * b - c;
  if (root_sq < 0 || c < 0) return kNever;
  const double along = -b - std::sqrt(root_sq);
  return along > 0 ? along : kNever;
}

}  // namespace

WalkingPeople::WalkingPeople(std::size_t count, const Motion& motion, const Raycaster& scene)
    : start_ns_(motion.startNs()) {
  const auto steps = static_cast<std::size_t>(motion.duration() / kStep_s) + 1;
  const Way way(motion, steps);
  for (std::size_t person = 0; person < count; ++person) {
    Track track;
    // Pieces of the way, spread over it evenly.
    const double middle = way.length() * (static_cast<double>(person) - 1.5) /
                          std::max(1.0, static_cast<double>(count) - 2);
    for (std::size_t i = 0; i < steps; ++i) {
      const double t = static_cast<double>(i) * kStep_s;
      const double turn = std::abs(std::remainder(kWalkingSpeed * t / kPiece, 2.0));  // 0..1
      const double s = person == 0   ? way.lengthAt(i) + kAhead
                       : person == 1 ? way.lengthAt(i) - kBehind
                                     : middle + kPiece * (turn - 0.5);
      track.push_back(onTheFloor(way.at(s), scene) + kBeside * way.leftOf(s));
    }
    tracks_.push_back(smoothed(track));
  }
}

Vec3 WalkingPeople::at(const Track& track, TimeNs t_ns) const {
  const double x = std::max(0.0, secondsBetween(start_ns_, t_ns) / kStep_s);
  const auto i = std::min(static_cast<std::size_t>(x), track.size() - 1);
  const std::size_t next = std::min(i + 1, track.size() - 1);
  return track[i] + std::min(1.0, x - static_cast<double>(i)) * (track[next] - track[i]);
}

void WalkingPeople::intersect(TimeNs t_ns, const Vec3& origin,
                              std::span<const Eigen::Vector3f> directions, std::uint32_t surface,
                              std::span<RayHit> hits) const {
  for (const Track& track : tracks_) {
    const Vec3 foot = at(track, t_ns), head = foot + Vec3(0, 0, shape_.head_m);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const Vec3 d = directions[i].cast<double>();
      const double body = toCylinder(origin, d, foot, shape_.radius_m, shape_.shoulder_m);
      const double ball = toBall(origin, d, head, shape_.head_radius_m);
      const double along = std::min(body, ball);
      if (along >= static_cast<double>(hits[i].distance_m)) continue;
      const Vec3 at = origin + along * d;
      Vec3 normal = ball < body ? Vec3(at - head) : Vec3(at.x() - foot.x(), at.y() - foot.y(), 0);
      hits[i].distance_m = static_cast<float>(along);
      hits[i].surface = surface;
      hits[i].normal_scene = normal.normalized().cast<float>();
    }
  }
}

}  // namespace paloc::synth
