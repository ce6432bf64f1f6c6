#include "paloc/tools/bench_start.h"

#include <chrono>
#include <cmath>
#include <fstream>
#include <numbers>

#include "paloc/core/mrpt_pose.h"
#include "paloc/core/text.h"
#include "paloc/map/scan_matcher.h"
#include "paloc/tools/bench_place.h"
#include "paloc/tools/synth_random.h"

namespace paloc {
namespace {

using synth::RandomPurpose;
using synth::RandomStream;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kFoundM = 0.1, kFoundRad = 1 * kDegree;
constexpr double kGravityErrorRad = 1 * kDegree;  // of an IMU that is carried
constexpr double kPositionErrorM = 0.5;           // of a position that somebody knows

Vec3 anyDirection(RandomStream& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return Vec3(x, y, z).normalized();
}

/// How badly a start is known.
struct Kind {
  enum class Known { kPose, kPosition, kNothing };
  const char* name;
  Known known;
  double off_m = 0, off_deg = 0;
  bool gravity = true;  ///< from an IMU; else the guess's own tilt, 2 degrees off
};

constexpr Kind kKinds[] = {
    {"1 m, 15 deg", Kind::Known::kPose, 1, 15},
    {"3 m, 45 deg", Kind::Known::kPose, 3, 45},
    {"position, 0.5 m", Kind::Known::kPosition, kPositionErrorM},
    {"nothing", Kind::Known::kNothing},
    {"1 m, 15 deg, no IMU", Kind::Known::kPose, 1, 15, false},
    {"3 m, 45 deg, no IMU", Kind::Known::kPose, 3, 45, false},
};

StartGuess guessOf(const Kind& kind, const Pose& truth, RandomStream& random) {
  StartGuess guess;
  const Vec3 off_position = kind.off_m * anyDirection(random);
  const Vec3 axis = anyDirection(random), up_off = anyDirection(random);
  const double sign = random.sign();
  if (kind.gravity) {
    guess.up_body =
        truth.rotation.transpose() * so3::exp(kGravityErrorRad * up_off) * Vec3::UnitZ();
  }
  if (kind.known == Kind::Known::kPosition) {
    guess.position_map = truth.position + off_position;
  } else if (kind.known == Kind::Known::kPose) {
    const double angle = kind.off_deg * kDegree;
    const Mat3 turn = kind.gravity
                          ? so3::exp(angle * axis)
                          : Mat3(so3::exp(Vec3(0, 0, sign * angle)) * so3::exp(2 * kDegree * axis));
    guess.T_map_body = toMrpt(Pose{truth.position + off_position, turn * truth.rotation});
  }
  return guess;
}

/// Starts and what came of them.
class Bench {
 public:
  Bench(const BenchStartSettings& settings, const BenchStartProgress& progress)
      : settings_(settings),
        progress_(progress),
        sensor_(synth::makeSensor(settings.sensor)),
        matching_(settings.matcher) {
    matching_.range_noise_m = sensor_.range_noise_m;
    if (settings.list_file.empty()) return;
    list_.open(settings.list_file);
    list_ << "scan,map,kind,place,answer,searched,error_m,error_deg,explained,blocked,runner_up,"
             "overlap,residual_rms_m,ms\n";
  }

  std::vector<BenchStartRow> rightMap() {
    const auto made = makePlace(synth::makeScene(settings_.scene));
    const BenchPlace& place = *made;
    const auto matcher = ScanMatcher::onto(place.map(), matching_);
    std::vector<BenchStartRow> rows;
    for (const Kind& kind : kKinds) rows.push_back({kind.name, false, 0, 0, 0, {}, {}});
    for (std::size_t i = 0; i < settings_.places; ++i) {
      progress_("the right map", static_cast<double>(i) / static_cast<double>(settings_.places));
      const Pose truth = place.pose(i);
      const Scan scan = place.scanAt(sensor_, truth, i);
      for (std::size_t k = 0; k < std::size(kKinds); ++k) {
        RandomStream random(settings_.seed, RandomPurpose::kStart, i);
        const StartGuess guess = guessOf(kKinds[k], truth, random);
        locate(*matcher, scan, guess, &truth, rows[k],
               text(place.scene().name, ',', place.scene().name, ',', '"', kKinds[k].name, '"', ',',
                    i));
      }
    }
    return rows;
  }

  std::vector<BenchStartRow> wrongMaps();

 private:
  std::unique_ptr<BenchPlace> makePlace(synth::Scene scene) const {
    synth::SurveyModel model;
    model.spacing_m = settings_.map_spacing_m;
    model.angular_step_deg = settings_.survey_step_deg;
    return std::make_unique<BenchPlace>(std::move(scene), model, settings_.map, settings_.seed);
  }

  void locate(ScanMatcher& matcher, const Scan& scan, const StartGuess& guess, const Pose* truth,
              BenchStartRow& row, const std::string& label);

  const BenchStartSettings& settings_;
  const BenchStartProgress& progress_;
  synth::SensorModel sensor_;
  MatcherSettings matching_;
  std::ofstream list_;
};

void Bench::locate(ScanMatcher& matcher, const Scan& scan, const StartGuess& guess,
                   const Pose* truth, BenchStartRow& row, const std::string& label) {
  const auto start = std::chrono::steady_clock::now();
  const MapMatch match = matcher.locate(scan, guess);
  const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - start;
  Vec6 error = Vec6::Constant(99);
  if (truth) error = boxminus(fromMrpt(match.T_map_body), *truth);
  const bool right =
      truth && error.head<3>().norm() < kFoundM && error.tail<3>().norm() < kFoundRad;
  ++row.starts;
  row.locate_ms.push_back(ms.count());
  if (!match.accepted()) {
    ++row.refused[toString(match.refusal)];
  } else {
    ++(right ? row.found : row.accepted);
  }
  if (!list_.is_open()) return;
  list_ << label << ',' << toString(match.refusal) << ',' << match.searched << ','
        << error.head<3>().norm() << ',' << error.tail<3>().norm() / kDegree << ','
        << match.explained << ',' << match.blocked << ',' << match.runner_up << ',' << match.overlap
        << ',' << match.residual_rms_m << ',' << ms.count() << '\n';
}

// Scenes that differ wherever one stands: a corridor turned by 30 degrees is the same corridor.
std::vector<synth::Scene> differentScenes() {
  std::vector<synth::Scene> scenes;
  for (const char* name : {"building", "room", "corridor-0", "tunnel", "open-field", "stairwell",
                           "parking-deck", "circular-hall"}) {
    scenes.push_back(synth::makeScene(name));
  }
  scenes.push_back(mirrored(synth::makeBuilding()));
  scenes.back().name = "building-mirrored";
  return scenes;
}

std::vector<BenchStartRow> Bench::wrongMaps() {
  std::vector<std::unique_ptr<BenchPlace>> places;
  std::vector<std::shared_ptr<ScanMatcher>> matchers;
  for (synth::Scene& scene : differentScenes()) {
    progress_("surveying " + scene.name, 0);
    places.push_back(makePlace(std::move(scene)));
    matchers.push_back(ScanMatcher::onto(places.back()->map(), matching_));
  }
  std::vector<BenchStartRow> rows;
  for (const Kind& kind : kKinds) rows.push_back({kind.name, true, 0, 0, 0, {}, {}});
  const std::size_t n = places.size(), pairs = n * (n - 1);
  for (std::size_t i = 0; i < settings_.wrong; ++i) {
    progress_("wrong maps", static_cast<double>(i) / static_cast<double>(settings_.wrong));
    const std::size_t pair = i % pairs, of = pair / (n - 1);
    const std::size_t in = pair % (n - 1) < of ? pair % (n - 1) : pair % (n - 1) + 1;
    // The pairs come round with another kind each time: their number is a multiple of that of
    // kinds.
    const std::size_t k = (i + i / pairs) % std::size(kKinds);
    RandomStream random(settings_.seed, RandomPurpose::kStart, i);
    const Scan scan = places[of]->scanAt(sensor_, places[of]->pose(i), i);
    // Somewhere that a body may be in that map, held as the body of the scan is.
    const Pose claimed{places[in]->pose(i).position, places[of]->pose(i).rotation};
    locate(*matchers[in], scan, guessOf(kKinds[k], claimed, random), nullptr, rows[k],
           text(places[of]->scene().name, ',', places[in]->scene().name, ',', '"', kKinds[k].name,
                '"', ',', i));
  }
  return rows;
}

}  // namespace

std::vector<BenchStartRow> benchStart(const BenchStartSettings& settings,
                                      const BenchStartProgress& progress) {
  Bench bench(settings, progress);
  std::vector<BenchStartRow> rows;
  if (settings.places > 0) rows = bench.rightMap();
  if (settings.wrong > 0) {
    for (BenchStartRow& row : bench.wrongMaps()) rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace paloc
