#include "start_finder.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace paloc {
namespace {

constexpr double kMaxCells = 6e7;       // 8 MB a grid, of which there are two a level
constexpr int kLevels = 7;              // cubes of up to 64 cells
constexpr double kUprightCosine = 0.7;  // of a map plane's normal to the vertical, at most
constexpr std::size_t kCandidates =
    36;  // where the true place is half missing, many have more hits
constexpr std::size_t kCoarsePoints = 800, kRays = 600;
constexpr std::size_t kFinePlaces = 3;  // that are registered with all points, and compared
// A place that leaves more than this may be held by the wrong faces of walls, a thickness off.
constexpr double kSureWorth = 0.95, kNudgeM = 0.15;
constexpr double kSamePlaceM = 0.3, kSamePlaceRad = 0.1;
// The more a place leaves unexplained, the more the next must: one that explains all but a tenth
// stands out from one that explains all but two, one that explains all but three does not from one
// with four. A quarter of the scan is enough in any case: half of the place may not be mapped.
constexpr double kLead = 2, kSureLead = 0.25;
// Of the share that must be explained in the end, grids may miss so much: points on edges of cells.
constexpr double kGridLoss = 0.1;

bool samePlace(const Pose& a, const Pose& b) {
  const Vec6 step = boxminus(a, b);
  return step.head<3>().norm() < kSamePlaceM && step.tail<3>().norm() < kSamePlaceRad;
}

}  // namespace

SearchBox StartFinder::everywhere() const {
  const PriorMap::Statistics& s = map_.statistics();
  return {s.low - map_.origin(), s.high - map_.origin(), -std::numbers::pi, std::numbers::pi};
}

const SearchMap& StartFinder::grids() {
  if (grids_) return *grids_;
  std::vector<Point3f> upright, all(map_.size());
  for (std::uint32_t i = 0; i < map_.size(); ++i) {
    all[i] = map_.point(i);
    const MapPlane plane = map_.plane(i);
    const bool level = plane.planar() && std::abs(static_cast<double>(plane.nz)) > kUprightCosine;
    if (!level) upright.push_back(all[i]);
  }
  const SearchBox box = everywhere();
  const GridFrame frame = GridFrame::over(box.low, box.high, settings_.start_cell_m, kMaxCells);
  grids_.reset(new SearchMap{frame, OccupancyPyramid(frame, upright, kLevels),
                             OccupancyPyramid(frame, all, kLevels)});
  return *grids_;
}

StartFinder::Place StartFinder::registerFrom(const Pose& from, double first_gate_m,
                                             std::size_t rays, Registration& registration) const {
  Place place;
  place.alignment = registration.align(
      from, {.first_gate_m = first_gate_m,
             .first_iterations = 6,
             .gate_m = std::min(settings_.fine_distance_m, settings_.max_distance_m),
             .max_iterations = settings_.max_iterations});
  place.evidence = weighStart(registration, place.alignment, map_, rays);
  return place;
}

// The candidates registered with some of the points, the best first, each place once.
std::vector<StartFinder::Place> StartFinder::placesOf(const StartCandidates& candidates,
                                                      const StartRegion& region,
                                                      Registration& registration) const {
  // A cell's diagonal, and as much again for heading and tilt.
  const double first_gate_m =
      std::max(settings_.max_distance_m, 2 * std::numbers::sqrt3 * grids_->frame.cell_m);
  std::vector<Place> places;
  for (const StartCandidate& candidate : candidates.found) {
    const Mat3 turn = so3::exp(Vec3(0, 0, candidate.yaw));
    places.push_back(registerFrom({candidate.position, turn * region.R_level_body}, first_gate_m,
                                  kRays / 4, registration));
  }
  std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return a.evidence.worth() > b.evidence.worth();
  });
  std::vector<Place> distinct;
  for (const Place& place : places) {
    const bool known = std::any_of(distinct.begin(), distinct.end(), [&](const Place& other) {
      return samePlace(place.alignment.T_local_body, other.alignment.T_local_body);
    });
    if (!known) distinct.push_back(place);
  }
  return distinct;
}

// The best of a place and of what registration comes to from beside it.
StartFinder::Place StartFinder::nudged(const Place& place, Registration& registration) const {
  if (place.evidence.worth() > kSureWorth) return place;
  Place best = place;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double by_m : {kNudgeM, -kNudgeM}) {
      Pose from = place.alignment.T_local_body;
      from.position[axis] += by_m;
      const Place other = registerFrom(from, settings_.max_distance_m, kRays, registration);
      if (other.evidence.worth() > best.evidence.worth()) best = other;
    }
  }
  return best;
}

MatchRefusal StartFinder::judge(FoundStart& found, bool finished,
                                const Registration& registration) const {
  if (!finished) return MatchRefusal::kSearchUnfinished;
  const double left = 1 - found.evidence.worth(), second_left = 1 - found.runner_up;
  const double lead = second_left - left;
  const bool ahead =
      lead >= kSureLead || (lead >= settings_.start_min_lead && second_left >= kLead * left);
  const MatchRefusal refusal =
      verifyStart(registration, found.alignment, map_, settings_, found.evidence);
  return refusal == MatchRefusal::kNone && !ahead ? MatchRefusal::kAmbiguous : refusal;
}

FoundStart StartFinder::find(const std::vector<Point3f>& points_body, const StartRegion& region,
                             Registration& registration) {
  const SearchMap& map = grids();
  const StartCandidates candidates = searchStarts(
      map, pickSearchPoints(points_body, region.R_level_body, map.frame.cell_m), region.box,
      {.min_share = settings_.start_min_explained - kGridLoss,
       .max_mlookups = settings_.start_max_mlookups,
       .candidates = kCandidates,
       .threads = settings_.threads});
  FoundStart found;
  if (candidates.found.empty()) {
    if (!candidates.finished) found.refusal = MatchRefusal::kSearchUnfinished;
    return found;
  }
  const AveragedPoints all = registration.averaged();
  const Vec3 sensor = registration.sensorPosition();
  registration.setPoints(all.everyNth(kCoarsePoints), sensor);
  std::vector<Place> places = placesOf(candidates, region, registration);
  registration.setPoints(all, sensor);
  places.resize(std::min(places.size(), kFinePlaces));
  for (Place& place : places) {
    place =
        registerFrom(place.alignment.T_local_body, settings_.max_distance_m, kRays, registration);
  }
  std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return a.evidence.worth() > b.evidence.worth();
  });
  places.front() = nudged(places.front(), registration);
  const Pose best = places.front().alignment.T_local_body;
  found.evidence = places.front().evidence;
  for (const Place& place : places) {
    if (samePlace(place.alignment.T_local_body, best)) continue;
    if (isRefuted(place.evidence, settings_)) continue;
    found.runner_up = place.evidence.worth();
    break;
  }
  found.alignment = registration.align(
      best, {.first_gate_m = settings_.max_distance_m,
             .gate_m = std::min(settings_.fine_distance_m, settings_.max_distance_m),
             .max_iterations = settings_.max_iterations});
  found.refusal = judge(found, candidates.finished, registration);
  return found;
}

}  // namespace paloc
