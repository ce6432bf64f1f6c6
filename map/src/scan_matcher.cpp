#include "paloc/map/scan_matcher.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "paloc/core/mrpt_pose.h"
#include "paloc/map/scan_averaging.h"
#include "paloc/map/scan_level.h"
#include "paloc/map/scan_normals.h"
#include "paloc/map/scan_thinning.h"
#include "paloc/map/spectrum.h"
#include "paloc/map/surface_patches.h"
#include "paloc/map/surface_register.h"
#include "parallel_chunks.h"
#include "point_vector.h"
#include "registration.h"
#include "rough_start.h"
#include "start_finder.h"
#include "start_region.h"
#include "stopwatch.h"

namespace paloc {
namespace {

constexpr double kSurelyExplained = 0.98;  // of a scan: elsewhere it cannot fit much better
constexpr double kNearM = 1, kNearRad = 0.25;
// From one patch of a surface to the next: their radii.
constexpr double kNextPatch = 2;
constexpr double kOutsideShare = 0.1;  // of the points near any map point, below: outside the map
// Of the matched points, so many are enough to compare two spectra, and so many neighbours for a
// normal.
constexpr std::size_t kSpectrumPoints = 150, kSpectrumNeighbours = 15, kSpectrumChunk = 25;

}  // namespace

class ScanMatcher::Work {
 public:
  Work(std::shared_ptr<const PriorMap> map, const MatcherSettings& settings)
      : map_(std::move(map)),
        settings_(settings),
        arena_(std::max(settings.threads, 1)),
        registration_(*map_, settings_, arena_),
        finder_(*map_, settings_),
        surfaces_(kNextPatch * settings.plane_patch_m) {}

  /// All work in one visit to the threads.
  template <typename Body>
  MapMatch onItsThreads(const Body& body) {
    return arena_.execute(body);
  }

  MapMatch match(const Scan& scan, const Pose& guess, double sigma_position,
                 double sigma_rotation) {
    MapMatch answer = begin(scan, guess);
    if (answer.refusal == MatchRefusal::kNoScan || tooFew(answer)) return answer;
    const AlignSchedule schedule{
        .first_gate_m = settings_.max_distance_m,
        .gate_m = std::min(settings_.fine_distance_m, settings_.max_distance_m),
        .max_iterations = settings_.max_iterations,
        .start_sigma_m = sigma_position};
    const auto registerFrom = [&](const Pose& start, MapMatch& match) {
      const Alignment alignment = registration_.align(start, schedule);
      std::optional<Pose> better;
      tbb::parallel_invoke([&] { better = fill(alignment, match, settings_.degeneracy_handling); },
                           [&] { addSpectrum(match.spectrum); });
      if (match.accepted() && stepTooLarge(guess, match, sigma_position, sigma_rotation)) {
        match.refusal = MatchRefusal::kLargeStep;
      }
      return better;
    };
    const std::optional<Pose> better = registerFrom(toLocal(guess), answer);
    if (!better) return answer;
    MapMatch there = answer;
    registerFrom(*better, there);
    return there.accepted() ? there : answer;
  }

  MapMatch locate(const Scan& scan, StartGuess guess) {
    // Registration alone does not need it: it is for the near.
    if (!guess.up_body && (guess.search_around || !guess.T_map_body)) {
      guess.up_body = levelOfScan(scan.points_body, upOf(guess));
    }
    if (!guess.T_map_body) return search(scan, guess);
    MapMatch direct = locateFrom(scan, levelled(guess));
    const bool sure = direct.accepted() && direct.explained >= kSurelyExplained;
    if (sure || !guess.search_around || !searchable(direct)) return direct;
    return theBetter(direct, search(scan, guess));
  }

  const Timing& timing() const { return timing_; }

 private:
  Pose toLocal(const Pose& pose) const { return {pose.position - map_->origin(), pose.rotation}; }

  // By registration alone.
  MapMatch locateFrom(const Scan& scan, const Pose& rough) {
    MapMatch answer = begin(scan, rough);
    if (answer.refusal == MatchRefusal::kNoScan || tooFew(answer)) return answer;
    const RoughStart found = searchAround(registration_, *map_, settings_, toLocal(rough));
    fill(found.alignment, answer, false);
    tellEvidence(found.evidence, answer);
    const Vec6 step = boxminus(fromMrpt(answer.T_map_body), rough);
    if (answer.accepted() && (step.head<3>().norm() > settings_.locate_max_step_m ||
                              step.tail<3>().norm() > settings_.locate_max_step_rad)) {
      answer.refusal = MatchRefusal::kLargeStep;
    }
    if (answer.accepted()) answer.refusal = found.refusal;
    return answer;
  }

  // Of what registration from a rough pose came to and what was found by search: the first may be
  // good enough, but not the best thereabouts. Somewhere else must fit much worse, or much better,
  // for either to be believed.
  MapMatch theBetter(MapMatch direct, const MapMatch& searched) const {
    if (!direct.accepted()) {
      const bool far_out = direct.refusal == MatchRefusal::kOutsideMap &&
                           searched.refusal == MatchRefusal::kNoPlaceFound;
      return far_out ? direct : searched;  // the more telling of the two
    }
    const double lead = worthOf(searched) - worthOf(direct);
    // Along an open direction the rough pose is all there is.
    if (lead <= 0 || leavesOpen(direct)) return direct;
    const Vec6 apart = boxminus(fromMrpt(searched.T_map_body), fromMrpt(direct.T_map_body));
    const bool near = apart.head<3>().norm() < kNearM && apart.tail<3>().norm() < kNearRad;
    if (near || lead >= settings_.start_min_lead) return searched;
    direct.refusal = MatchRefusal::kAmbiguous;
    return direct;
  }

  static double worthOf(const MapMatch& match) {
    return match.explained - match.blocked - match.contradicted;
  }

  static bool leavesOpen(const MapMatch& match) {
    return std::any_of(
        match.directions.begin(), match.directions.end(),
        [](const MatchDirection& direction) { return direction.cls == DirectionClass::kNone; });
  }

  static bool searchable(const MapMatch& refused) {
    return refused.refusal != MatchRefusal::kNoScan &&
           refused.refusal != MatchRefusal::kTooFewPoints;
  }

  MapMatch search(const Scan& scan, const StartGuess& guess) {
    MapMatch answer = begin(scan, guess.T_map_body ? fromMrpt(*guess.T_map_body) : Pose{});
    answer.searched = true;
    if (answer.refusal == MatchRefusal::kNoScan || tooFew(answer)) return answer;
    const FoundStart found = finder_.find(
        scan.points_body, startRegion(guess, map_->origin(), finder_.everywhere(), settings_),
        registration_);
    if (found.alignment.iterations == 0) {
      answer.refusal = found.refusal;
      return answer;
    }
    fill(found.alignment, answer, false);
    tellEvidence(found.evidence, answer);
    answer.runner_up = found.runner_up;
    if (answer.accepted()) answer.refusal = found.refusal;
    // Along a direction that the map leaves open, any place would have done as well.
    if (answer.accepted() && leavesOpen(answer)) answer.refusal = MatchRefusal::kAmbiguous;
    return answer;
  }

  static void tellEvidence(const StartEvidence& evidence, MapMatch& answer) {
    answer.explained = evidence.explained;
    answer.blocked = evidence.blocked;
    answer.contradicted = evidence.contradicted;
  }

  // Thins the scan and sets it up. The answer still says "not converged".
  MapMatch begin(const Scan& scan, const Pose& guess) {
    timing_ = {};
    MapMatch answer;
    answer.T_map_body = toMrpt(guess);
    if (scan.points_body.empty()) {
      answer.refusal = MatchRefusal::kNoScan;
      return answer;
    }
    const Stopwatch stopwatch;
    AveragedPoints averaged = thinned(scan);
    timing_.filter_s = stopwatch.seconds();
    answer.points = static_cast<int>(averaged.points.size());
    Scan tried{scan.start_ns, scan.end_ns, averaged.points, scan.sensor_position_body,
               averaged.returns};
    tried.skew_covariance = skew_covariance_ = scan.skew_covariance;
    answer.thinned = std::make_shared<const Scan>(std::move(tried));
    registration_.setPoints(std::move(averaged), scan.sensor_position_body);
    return answer;
  }

  AveragedPoints thinned(const Scan& scan) {
    if (!scan.returns.empty()) return {scan.points_body, scan.returns};
    const std::vector<std::uint32_t> kept =
        thinning_.select(scan.points_body, scan.sensor_position_body,
                         static_cast<std::size_t>(std::max(settings_.max_points, 1)));
    const auto run = [this](std::size_t count, const std::function<void(std::size_t)>& job) {
      forEachChunk(arena_, count, 1, [&job](std::size_t i, std::size_t, std::size_t) { job(i); });
    };
    return averaging_.average(scan.points_body, kept, scan.sensor_position_body,
                              settings_.range_noise_m, run);
  }

  bool tooFew(MapMatch& answer) const {
    if (answer.points >= settings_.min_inliers) return false;
    answer.refusal = MatchRefusal::kTooFewPoints;
    return true;
  }

  // Where `probing`, returns where the scan lies better, if it does anywhere.
  std::optional<Pose> fill(const Alignment& alignment, MapMatch& answer, bool probing) {
    const Stopwatch stopwatch;
    timing_.association_s += alignment.timing.association_s;
    timing_.solve_s += alignment.timing.solve_s;
    const Pose& local = alignment.T_local_body;
    answer.T_map_body = toMrpt(Pose{local.position + map_->origin(), local.rotation});
    answer.matched = alignment.matched;
    answer.inliers = alignment.inliers;
    answer.overlap = static_cast<double>(alignment.matched) / answer.points;
    answer.residual_rms_m = alignment.residual_rms_m;
    answer.residual_median_m = alignment.residual_median_m;
    answer.iterations = alignment.iterations;
    answer.refusal = gate(alignment, answer);
    std::optional<Pose> better;
    if (!registration_.rows().empty()) {
      std::optional<DirectionObserver> observer;
      MotionCheck worse;
      if (probing) {
        worse = [&](const Motion& motion) {
          const MotionProbe::Answer probed = registration_.probe(motion);
          if (probed.better) better = probed.better;
          return probed.clearness;
        };
      }
      Registration::Shared shared;
      tbb::parallel_invoke(
          [&] { observer.emplace(registration_.rows(), settings_.normal_noise_rad, worse); },
          [&] { shared = registration_.sharedErrorsOfRows(); });
      // As a motion of the pose it moves the gradient by the information times that.
      shared.spread += observer->information() * skew_covariance_ * observer->information();
      const ObservedDirections observed = observer->under(shared.spread);
      answer.directions = observed.directions;
      const bool handled = settings_.degeneracy_handling;
      const Mat6 information =
          handled ? observed.information : leastSquares(registration_.rows()).information;
      const Mat6& spread = handled ? observed.shared_spread : shared.spread;
      answer.information = informationInMap(information, local.rotation);
      answer.shared_spread = informationInMap(spread, local.rotation);
      keepWhatMatters(observer->information(), shared.spread, settings_.plane_bias_m,
                      shared.patches);
      if (answer.accepted()) addSurfaces(shared.patches, local, answer);
    }
    timing_.information_s += stopwatch.seconds();
    return better;
  }

  void addSurfaces(const std::vector<SurfacePatch>& patches, const Pose& local, MapMatch& answer) {
    auto surfaces = std::make_shared<std::vector<SurfaceGradient>>();
    for (const SurfacePatch& patch : patches) {
      SurfaceGradient& surface = surfaces->emplace_back();
      surface.surface = surfaces_.surfaceOf(local.rotation * patch.normal, local * patch.point);
      surface.gradient = patch.gradient;
      surface.gradient.head<3>() = local.rotation * patch.gradient.head<3>();
    }
    answer.surfaces = std::move(surfaces);
    answer.surface_bias_m = settings_.plane_bias_m;
  }

  void addSpectrum(double& spectrum) {
    if (!settings_.spectrum) return;
    const Stopwatch stopwatch;
    spectrum = spectrumOfRows();
    timing_.spectrum_s += stopwatch.seconds();
  }

  // The scan's own surfaces against the map's, at some of the matched points, evenly; in chunks,
  // for whichever thread has nothing else to do.
  double spectrumOfRows() {
    const std::vector<PlaneRow>& rows = registration_.rows();
    const ScanNormals scan_normals(registration_.points());
    const double radius_m = scan_normals.radiusFor(kSpectrumNeighbours);
    const std::size_t step = std::max<std::size_t>(chunkCount(rows.size(), kSpectrumPoints), 1);
    std::vector<TwoNormals> points(chunkCount(rows.size(), step));
    forEachChunk(arena_, points.size(), kSpectrumChunk,
                 [&](std::size_t, std::size_t begin, std::size_t end) {
                   for (std::size_t k = begin; k < end; ++k) {
                     const PlaneRow& row = rows[k * step];
                     points[k] = {row.point_body,
                                  scan_normals.at(toPoint(row.point_body), radius_m),
                                  row.normal_body};
                   }
                 });
    std::erase_if(points, [](const TwoNormals& point) { return point.scan_normal.isZero(); });
    return spectrumDifference(points);
  }

  MatchRefusal gate(const Alignment& alignment, const MapMatch& answer) const {
    if (alignment.near < kOutsideShare * answer.points) return MatchRefusal::kOutsideMap;
    if (answer.inliers < settings_.min_inliers) return MatchRefusal::kTooFewInliers;
    if (answer.overlap < settings_.min_overlap) return MatchRefusal::kLowOverlap;
    if (answer.residual_rms_m > settings_.max_residual_rms_m) return MatchRefusal::kHighResidual;
    return alignment.converged ? MatchRefusal::kNone : MatchRefusal::kNotConverged;
  }

  bool stepTooLarge(const Pose& guess, const MapMatch& answer, double sigma_position,
                    double sigma_rotation) const {
    const Vec6 step = boxminus(fromMrpt(answer.T_map_body), guess);
    const auto distanceSq = [](double length, double sigma, double floor) {
      return length * length / std::max(sigma * sigma + floor * floor, 1e-12);
    };
    const double limit_sq = settings_.max_step_sigmas * settings_.max_step_sigmas;
    return distanceSq(step.head<3>().norm(), sigma_position, settings_.step_floor_m) > limit_sq ||
           distanceSq(step.tail<3>().norm(), sigma_rotation, settings_.step_floor_rad) > limit_sq;
  }

  std::shared_ptr<const PriorMap> map_;
  MatcherSettings settings_;
  tbb::task_arena arena_;
  Registration registration_;
  ScanThinning thinning_;
  ScanAveraging averaging_;
  StartFinder finder_;
  SurfaceRegister surfaces_;
  Mat6 skew_covariance_ = Mat6::Zero();  // of the scan in hand
  Timing timing_;
};

std::shared_ptr<ScanMatcher> ScanMatcher::onto(std::shared_ptr<const PriorMap> map,
                                               const MatcherSettings& settings) {
  return std::shared_ptr<ScanMatcher>(
      new ScanMatcher(std::make_unique<Work>(std::move(map), settings)));
}

ScanMatcher::ScanMatcher(std::unique_ptr<Work> work) : work_(std::move(work)) {}
ScanMatcher::~ScanMatcher() = default;

MapMatch ScanMatcher::match(const Scan& scan, const mrpt::poses::CPose3D& T_map_body_guess,
                            double guess_sigma_position, double guess_sigma_rotation) {
  return work_->onItsThreads([&] {
    return work_->match(scan, fromMrpt(T_map_body_guess), guess_sigma_position,
                        guess_sigma_rotation);
  });
}

MapMatch ScanMatcher::locate(const Scan& scan, const StartGuess& guess) {
  return work_->onItsThreads([&] { return work_->locate(scan, guess); });
}

const ScanMatcher::Timing& ScanMatcher::lastTiming() const { return work_->timing(); }

}  // namespace paloc
