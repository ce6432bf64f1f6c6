#include "paloc/tools/bench_registration.h"

#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>

#include "paloc/core/errors.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/core/text.h"
#include "paloc/frontends/tum_file.h"
#include "paloc/map/cloud_io.h"
#include "paloc/map/scan_matcher.h"
#include "paloc/tools/bench_rooms.h"
#include "paloc/tools/quantile.h"
#include "paloc/tools/synth_random.h"
#include "paloc/tools/synth_raycaster.h"
#include "paloc/tools/synth_sensor.h"
#include "temporary_folder.h"

namespace paloc {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A scan, where it was taken and where its registration starts.
struct Case {
  Scan scan;
  Pose truth, guess;
};

Vec3 anyDirection(synth::RandomStream& random) {
  Vec3 v(random.normal(), random.normal(), random.normal());
  return v.normalized();
}

Pose guessNear(const Pose& truth, const BenchRegistrationSettings& settings, std::size_t index) {
  synth::RandomStream random(settings.seed, synth::RandomPurpose::kRooms, index + 1);
  Vec6 off;
  off.head<3>() = settings.off_m * anyDirection(random);
  off.tail<3>() = settings.off_deg * kDegree * anyDirection(random);
  return boxplus(truth, off);
}

std::vector<Case> simulatedCases(const synth::Rooms& rooms,
                                 const BenchRegistrationSettings& settings) {
  synth::SensorModel sensor = synth::makeSensor("os1-128");
  sensor.range_noise_m = settings.range_noise_m;
  const synth::Raycaster raycaster(rooms.mesh);
  std::vector<Case> cases;
  for (std::size_t i = 0; i < rooms.places.size(); ++i) {
    const synth::Motion still({rooms.places[i]}, 1, 0);
    const synth::Surroundings surroundings(raycaster);
    const synth::LidarSimulator simulator(sensor, Pose{}, rooms.mesh, surroundings, still,
                                          settings.seed);
    const auto seen = simulator.scan(i, 0);
    Case one;
    for (std::size_t k = 0; k < seen->x.size(); ++k) {
      one.scan.points_body.push_back({seen->x[k], seen->y[k], seen->z[k]});
    }
    one.truth = rooms.places[i];
    one.guess = guessNear(one.truth, settings, i);
    cases.push_back(std::move(one));
  }
  return cases;
}

/// The scans of a folder in the order of their names, the k-th from the k-th pose; of many, some,
/// evenly.
std::vector<Case> recordedCases(const BenchRegistrationSettings& settings) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(settings.scans)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  const std::vector<StampedPose> poses = readTum(settings.poses);
  if (poses.size() != files.size() || files.empty()) {
    throw UsageError(text(settings.scans.string(), " holds ", files.size(), " scans and ",
                          settings.poses.string(), ' ', poses.size(),
                          " poses: there must be one pose for each scan"));
  }
  const std::size_t step = std::max<std::size_t>(files.size() / settings.places, 1);
  std::vector<Case> cases;
  for (std::size_t i = 0; i < files.size() && cases.size() < settings.places; i += step) {
    Case one;
    one.scan.points_body = loadCloud(files[i]).points;
    one.truth = poses[i].pose;
    one.guess = guessNear(one.truth, settings, i);
    cases.push_back(std::move(one));
  }
  return cases;
}

ScanQuantiles quantilesOf(const std::vector<double>& values) {
  return {quantile(values, 0.5), quantile(values, 0.95), quantile(values, 0.99)};
}

/// What was measured of one scan.
struct CaseResult {
  double match_ms = 1e300, cpu_ms = 0, filter_ms = 0, association_ms = 0, solve_ms = 0,
         information_ms = 0, spectrum_ms = 0;
  MapMatch match;
};

double processorMs() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

CaseResult registerOnce(ScanMatcher& matcher, const Case& one) {
  CaseResult result;
  const double before_ms = processorMs();
  const auto start = std::chrono::steady_clock::now();
  result.match = matcher.match(one.scan, toMrpt(one.guess), 0.1, 0.02);
  const std::chrono::duration<double, std::milli> whole = std::chrono::steady_clock::now() - start;
  result.cpu_ms = processorMs() - before_ms;
  const ScanMatcher::Timing& timing = matcher.lastTiming();
  result.filter_ms = 1e3 * timing.filter_s;
  result.association_ms = 1e3 * timing.association_s;
  result.solve_ms = 1e3 * timing.solve_s;
  result.information_ms = 1e3 * timing.information_s;
  result.spectrum_ms = 1e3 * timing.spectrum_s;
  result.match_ms = whole.count() - result.filter_ms;
  return result;
}

void summarize(const std::vector<Case>& cases, const std::vector<CaseResult>& results,
               RegistrationRun& run) {
  std::vector<double> match, cpu, filter, association, solve, information, pose, spectrum, error,
      turn;
  const double share = 1 / static_cast<double>(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const CaseResult& r = results[i];
    match.push_back(r.match_ms);
    cpu.push_back(r.cpu_ms);
    filter.push_back(r.filter_ms);
    association.push_back(r.association_ms);
    solve.push_back(r.solve_ms);
    information.push_back(r.information_ms);
    pose.push_back(r.association_ms + r.solve_ms + r.information_ms);
    spectrum.push_back(r.spectrum_ms);
    run.points_in += share * static_cast<double>(cases[i].scan.points_body.size());
    run.points_used += share * r.match.points;
    run.matched += share * r.match.matched;
    run.iterations += share * r.match.iterations;
    if (!r.match.accepted()) continue;
    ++run.accepted;
    const Vec6 off = boxminus(fromMrpt(r.match.T_map_body), cases[i].truth);
    error.push_back(off.head<3>().norm());
    turn.push_back(off.tail<3>().norm());
  }
  run.scans = cases.size();
  run.match_ms = quantilesOf(match);
  run.cpu_ms = quantilesOf(cpu);
  run.filter_ms = quantilesOf(filter);
  run.association_ms = quantilesOf(association);
  run.solve_ms = quantilesOf(solve);
  run.information_ms = quantilesOf(information);
  run.pose_ms = quantilesOf(pose);
  run.spectrum_ms = quantilesOf(spectrum);
  run.error_m = quantilesOf(error);
  run.error_rad = quantilesOf(turn);
}

RegistrationRun measure(std::shared_ptr<const PriorMap> map, const std::vector<Case>& cases,
                        MatcherSettings matcher_settings, int repeat) {
  RegistrationRun run;
  const auto matcher = ScanMatcher::onto(std::move(map), matcher_settings);
  std::vector<CaseResult> results(cases.size());
  for (int pass = 0; pass < repeat; ++pass) {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      CaseResult result = registerOnce(*matcher, cases[i]);
      if (result.match_ms < results[i].match_ms) results[i] = std::move(result);
    }
  }
  summarize(cases, results, run);
  return run;
}

/// All sizes of scan onto one map file, on each number of threads.
void measureOnto(const std::filesystem::path& map_file, const std::vector<Case>& cases,
                 const BenchRegistrationSettings& settings, const Config& config,
                 std::vector<RegistrationRun>& runs) {
  for (const int threads : settings.threads) {
    MapSettings map_settings = config.map;
    map_settings.threads = threads;
    const auto start = std::chrono::steady_clock::now();
    const auto map = PriorMap::load(map_file, map_settings);
    const double load_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const PriorMap::Statistics& built = map->statistics();
    for (const int points : settings.points) {
      MatcherSettings matcher = config.matcher;
      matcher.threads = threads;
      matcher.max_points = points;
      RegistrationRun run;
      if (!cases.empty()) run = measure(map, cases, matcher, settings.repeat);
      run.map_points = built.points;
      run.planar = built.planar;
      run.points = points;
      run.threads = threads;
      run.load_s = load_s;
      run.sort_s = built.sort_s;
      run.index_s = built.index_s;
      run.planes_s = built.planes_s;
      run.bytes_a_point = static_cast<double>(built.bytes) / static_cast<double>(built.points);
      runs.push_back(run);
    }
  }
}

}  // namespace

std::vector<RegistrationRun> benchRegistration(const BenchRegistrationSettings& settings,
                                               const Config& config) {
  std::vector<RegistrationRun> runs;
  if (!settings.map.empty()) {
    std::vector<Case> cases;
    if (!settings.scans.empty()) cases = recordedCases(settings);
    measureOnto(settings.map, cases, settings, config, runs);
    return runs;
  }
  Config noisy = config;
  noisy.matcher.range_noise_m = settings.range_noise_m;
  const TemporaryFolder folder;
  for (const std::size_t map_points : settings.map_points) {
    const double surface_m2 =
        static_cast<double>(map_points) * settings.spacing_m * settings.spacing_m;
    const synth::Rooms rooms = synth::makeRooms(surface_m2, settings.places, settings.seed);
    const std::filesystem::path file = folder.path() / "map.ply";
    savePly(file, synth::sampleSurfaces(rooms.mesh, settings.spacing_m, settings.map_noise_m,
                                        settings.seed));
    measureOnto(file, simulatedCases(rooms, settings), settings, noisy, runs);
  }
  return runs;
}

}  // namespace paloc
