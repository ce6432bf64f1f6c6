#include "paloc/tools/eval_changes.h"

#include <array>
#include <cmath>
#include <functional>
#include <map>

namespace paloc {
namespace {

constexpr double kFoundWithin_m = 0.08;  // points stand for about 5 cm
// Recall is asked of what surely belongs to the changed thing, not to what stands beside it.
constexpr double kBeside_m = 0.02, kAboveFloor_m = 0.1;

Vec3 positionOf(const PointCloud& cloud, std::size_t i) {
  const Point3f& p = cloud.points[i];
  return cloud.origin +
         Vec3(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
}

/// Points of one kind, to ask whether one is near.
class NearPoints {
 public:
  NearPoints(const MapChanges& changes, MapChange kind) {
    for (std::size_t i = 0; i < changes.kinds.size(); ++i) {
      if (changes.kinds[i] != kind) continue;
      const Vec3 p = positionOf(changes.cloud, i);
      cells_[cellOf(p)].push_back(p);
    }
  }
  bool near(const Vec3& p) const {
    const Cell low = cellOf(p - Vec3::Constant(kFoundWithin_m));
    const Cell high = cellOf(p + Vec3::Constant(kFoundWithin_m));
    for (long x = low[0]; x <= high[0]; ++x) {
      for (long y = low[1]; y <= high[1]; ++y) {
        for (long z = low[2]; z <= high[2]; ++z) {
          if (nearIn({x, y, z}, p)) return true;
        }
      }
    }
    return false;
  }

 private:
  using Cell = std::array<long, 3>;
  static Cell cellOf(const Vec3& p) {
    const auto cell = [](double c) { return std::lround(std::floor(c / kFoundWithin_m)); };
    return {cell(p.x()), cell(p.y()), cell(p.z())};
  }
  bool nearIn(const Cell& cell, const Vec3& p) const {
    const auto found = cells_.find(cell);
    if (found == cells_.end()) return false;
    for (const Vec3& q : found->second) {
      if ((p - q).norm() < kFoundWithin_m) return true;
    }
    return false;
  }
  std::map<Cell, std::vector<Vec3>> cells_;
};

using Where = std::function<bool(const Vec3& p_map)>;

std::size_t countCorrect(const MapChanges& changes, MapChange kind, const Where& where) {
  std::size_t correct = 0;
  for (std::size_t i = 0; i < changes.kinds.size(); ++i) {
    correct += changes.kinds[i] == kind && where(positionOf(changes.cloud, i));
  }
  return correct;
}

struct Found {
  std::size_t there = 0, found = 0;
};

Found countFound(const PointCloud& cloud, const NearPoints& reported, const Where& where) {
  Found count;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 p = positionOf(cloud, i);
    if (!where(p)) continue;
    ++count.there;
    count.found += reported.near(p);
  }
  return count;
}

class Evaluation {
 public:
  Evaluation(const ChangeTruth& truth, const EvalChangesInput& input, double tolerance_m)
      : truth_(truth), input_(input), tolerance_m_(tolerance_m) {}

  EvalChangesResult run() {
    std::size_t at = 0;
    for (const MapChange kind : kAllMapChanges) {
      const NearPoints reported(input_.changes, kind);
      ChangeScore& score = result_.kinds[at++];
      score.kind = kind;
      score.reported = input_.changes.count(kind);
      score.correct = countCorrect(input_.changes, kind, [&](const Vec3& p) {
        return changedAt(kind, p, tolerance_m_, tolerance_m_);
      });
      const Found found = countFound(cloudOf(kind), reported, [&](const Vec3& p) {
        return changedAt(kind, p, kBeside_m, -kAboveFloor_m) && !isHiddenByGap(kind, p);
      });
      score.there = found.there;
      score.found = found.found;
      scoreObjects(kind, reported);
    }
    return result_;
  }

 private:
  const PointCloud& cloudOf(MapChange kind) const {
    return kind == MapChange::kGone ? input_.map : input_.scans;
  }

  bool changedAt(MapChange kind, const Vec3& p, double margin_m, double below_m) const {
    switch (kind) {
      case MapChange::kGone:
        return inAny(truth_.gone, p, margin_m, below_m);
      case MapChange::kAdded:
        return inAny(truth_.added, p, margin_m, below_m);
      case MapChange::kMoved:
        return truth_.sweptByPeople(p, margin_m, below_m);
      case MapChange::kUnmapped:
        for (const ChangeTruth::Region& region : truth_.missing) {
          if (region.contains(p, margin_m)) return true;
        }
    }
    return false;
  }

  // What was added where the map has nothing at all cannot be told from the place itself.
  bool isHiddenByGap(MapChange kind, const Vec3& p) const {
    return kind == MapChange::kAdded && changedAt(MapChange::kUnmapped, p, 0, 0);
  }

  bool inAny(const std::vector<ChangeTruth::Box>& boxes, const Vec3& p, double margin_m,
             double below_m) const {
    for (const ChangeTruth::Box& box : boxes) {
      if (box.contains(p, margin_m, below_m)) return true;
    }
    return false;
  }

  void scoreObjects(MapChange kind, const NearPoints& reported) {
    if (kind != MapChange::kGone && kind != MapChange::kAdded) return;
    for (const ChangeTruth::Box& box : kind == MapChange::kGone ? truth_.gone : truth_.added) {
      const Found found = countFound(cloudOf(kind), reported, [&](const Vec3& p) {
        return box.contains(p, kBeside_m, -kAboveFloor_m);
      });
      result_.objects.push_back({box.name, kind, found.there, found.found});
    }
  }

  const ChangeTruth& truth_;
  const EvalChangesInput& input_;
  double tolerance_m_;
  EvalChangesResult result_;
};

std::optional<double> share(std::size_t part, std::size_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

std::optional<double> ChangeScore::precision() const { return share(correct, reported); }
std::optional<double> ChangeScore::recall() const { return share(found, there); }

EvalChangesResult evaluateChanges(const ChangeTruth& truth, const EvalChangesInput& input,
                                  double tolerance_m) {
  return Evaluation(truth, input, tolerance_m).run();
}

}  // namespace paloc
