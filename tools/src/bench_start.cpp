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
constexpr std::size_t kStoreys = 5;               // of the building, itself included

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

std::vector<BenchStartRow> emptyRows(BenchStartMap map) {
  std::vector<BenchStartRow> rows;
  for (const Kind& kind : kKinds) rows.push_back({kind.name, map});
  return rows;
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
    list_ << "scan,map,kind,place,answer,searched,error_m,error_deg,explained,blocked,contradicted,"
             "runner_up,"
             "overlap,residual_rms_m,ms\n";
  }

  std::vector<BenchStartRow> rightMap();
  std::vector<BenchStartRow> partialMaps();
  std::vector<BenchStartRow> wrongMaps();
  std::vector<BenchStartRow> otherStoreys();

 private:
  std::unique_ptr<BenchPlace> makePlace(synth::Scene scene) const {
    synth::SurveyModel model;
    model.spacing_m = settings_.map_spacing_m;
    model.angular_step_deg = settings_.survey_step_deg;
    return std::make_unique<BenchPlace>(std::move(scene), model, settings_.map, settings_.seed);
  }

  // A scan at a pose of the place, looked for in a map of it from every kind of start.
  void locateFromAll(ScanMatcher& matcher, const BenchPlace& place, std::size_t index,
                     std::vector<BenchStartRow>& rows);
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
        << match.explained << ',' << match.blocked << ',' << match.contradicted << ','
        << match.runner_up << ',' << match.overlap << ',' << match.residual_rms_m << ','
        << ms.count() << '\n';
}

void Bench::locateFromAll(ScanMatcher& matcher, const BenchPlace& place, std::size_t index,
                          std::vector<BenchStartRow>& rows) {
  const Pose truth = place.pose(index);
  const Scan scan = place.scanAt(sensor_, truth, index);
  for (std::size_t k = 0; k < std::size(kKinds); ++k) {
    RandomStream random(settings_.seed, RandomPurpose::kStart, index);
    const StartGuess guess = guessOf(kKinds[k], truth, random);
    locate(matcher, scan, guess, &truth, rows[k],
           text(place.scene().name, ',', nameOf(rows[k].map), ',', '"', kKinds[k].name, '"', ',',
                index));
  }
}

std::vector<BenchStartRow> Bench::rightMap() {
  const auto place = makePlace(synth::makeScene(settings_.scene));
  const auto matcher = ScanMatcher::onto(place->map(), matching_);
  std::vector<BenchStartRow> rows = emptyRows(BenchStartMap::kRight);
  for (std::size_t i = 0; i < settings_.places; ++i) {
    progress_("the right map", static_cast<double>(i) / static_cast<double>(settings_.places));
    locateFromAll(*matcher, *place, i, rows);
  }
  return rows;
}

// At each place another part is missing: all beyond an upright plane that passes within a metre.
std::vector<BenchStartRow> Bench::partialMaps() {
  const auto place = makePlace(synth::makeScene(settings_.scene));
  std::vector<BenchStartRow> rows = emptyRows(BenchStartMap::kPart);
  for (std::size_t i = 0; i < settings_.partial; ++i) {
    progress_("parts of the map", static_cast<double>(i) / static_cast<double>(settings_.partial));
    RandomStream random(settings_.seed, RandomPurpose::kMissing, i);
    const double heading = 2 * std::numbers::pi * random.uniform();
    const Vec3 normal(std::cos(heading), std::sin(heading), 0);
    const double height = normal.dot(place->pose(i).position) + 2 * random.uniform() - 1;
    const auto matcher = ScanMatcher::onto(place->mapBefore(normal, height), matching_);
    locateFromAll(*matcher, *place, i, rows);
  }
  return rows;
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
  std::vector<BenchStartRow> rows = emptyRows(BenchStartMap::kWrong);
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

// Who has taken the map of the wrong storey starts from where the right one would have it.
std::vector<BenchStartRow> Bench::otherStoreys() {
  std::vector<std::unique_ptr<BenchPlace>> places;
  std::vector<std::shared_ptr<ScanMatcher>> matchers;
  for (std::uint64_t storey = 0; storey < kStoreys; ++storey) {
    progress_("surveying storeys", static_cast<double>(storey) / kStoreys);
    places.push_back(
        makePlace(storey == 0 ? synth::makeScene("building") : synth::makeBuildingStorey(storey)));
    matchers.push_back(ScanMatcher::onto(places.back()->map(), matching_));
  }
  std::vector<BenchStartRow> rows = emptyRows(BenchStartMap::kStorey);
  for (std::size_t i = 0; i < settings_.storeys; ++i) {
    progress_("other storeys", static_cast<double>(i) / static_cast<double>(settings_.storeys));
    // All scans are of the building itself, whose way is clear of its own furniture.
    const std::size_t in = 1 + i % (kStoreys - 1);
    const std::size_t k = i / (kStoreys - 1) % std::size(kKinds);
    RandomStream random(settings_.seed, RandomPurpose::kStart, i);
    const Pose truth = places[0]->pose(i);
    locate(*matchers[in], places[0]->scanAt(sensor_, truth, i), guessOf(kKinds[k], truth, random),
           nullptr, rows[k],
           text(places[0]->scene().name, ',', places[in]->scene().name, ',', '"', kKinds[k].name,
                '"', ',', i));
  }
  return rows;
}

}  // namespace

std::string nameOf(BenchStartMap map) {
  switch (map) {
    case BenchStartMap::kRight:
      return "right";
    case BenchStartMap::kPart:
      return "part";
    case BenchStartMap::kWrong:
      return "wrong";
    case BenchStartMap::kStorey:
      return "storey";
  }
  return "";
}

std::vector<BenchStartRow> benchStart(const BenchStartSettings& settings,
                                      const BenchStartProgress& progress) {
  Bench bench(settings, progress);
  std::vector<BenchStartRow> rows;
  const auto take = [&](std::vector<BenchStartRow> more) {
    for (BenchStartRow& row : more) rows.push_back(std::move(row));
  };
  if (settings.places > 0) take(bench.rightMap());
  if (settings.partial > 0) take(bench.partialMaps());
  if (settings.wrong > 0) take(bench.wrongMaps());
  if (settings.storeys > 0) take(bench.otherStoreys());
  return rows;
}

}  // namespace paloc
