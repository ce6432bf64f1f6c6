#include "paloc/tools/synth_scene.h"

// x across the two flights, y along them. From each storey's landing (at low y) a flight leads up
// to a half landing (at high y) on the side of low x, and another one back on the other side.
namespace paloc::synth {
namespace {

constexpr int kStoreys = 3, kSteps = 9;  // steps of a flight
constexpr double kWidth = 2.8, kFlightWidth = 1.3, kLanding = 1.6, kRun = 0.3;
constexpr double kFlight = kSteps * kRun, kLength = 2 * kLanding + kFlight;
constexpr double kStoreyHeight = 3, kTop = (kStoreys + 1) * kStoreyHeight;
constexpr double kRise = kStoreyHeight / (2 * kSteps), kSlab = 0.18;
constexpr float kPlaster = 0.7F, kStone = 0.4F;

void addWalls(MeshBuilder& b) {
  constexpr double kThickness = 0.2, kOuter = kThickness / 2;
  b.box(Pose{}, Vec3(0, 0, -0.2), Vec3(kWidth, kLength, 0), kStone);
  b.box(Pose{}, Vec3(0, 0, kTop), Vec3(kWidth, kLength, kTop + 0.2), kPlaster);
  b.wall(onFloor(0, -kOuter), kWidth, kThickness, kTop, {}, kPlaster);
  b.wall(onFloor(0, kLength + kOuter), kWidth, kThickness, kTop, {}, kPlaster);
  b.wall(onFloor(-kOuter, 0, 90), kLength, kThickness, kTop, {}, kPlaster);
  b.wall(onFloor(kWidth + kOuter, 0, 90), kLength, kThickness, kTop, {}, kPlaster);
}

/// Steps that rise along the piece's y from its origin.
void addFlight(MeshBuilder& b, const Pose& T_scene_flight) {
  for (int i = 0; i < kSteps; ++i) {
    const double y = i * kRun, z = (i + 1) * kRise;
    b.box(T_scene_flight, Vec3(0, y, z - kSlab - kRise), Vec3(kFlightWidth, y + kRun, z), kStone);
  }
}

void addStorey(MeshBuilder& b, double z) {
  const double half = z + kStoreyHeight / 2, next = z + kStoreyHeight;
  addFlight(b, onFloor(0, kLanding, 0, z));
  addFlight(b, onFloor(kWidth, kLanding + kFlight, 180, half));
  b.box(Pose{}, Vec3(0, kLanding + kFlight, half - kSlab), Vec3(kWidth, kLength, half), kStone);
  b.box(Pose{}, Vec3(0, 0, next - kSlab), Vec3(kWidth, kLanding, next), kStone);
  // The door of the storey, and a lamp over the half landing.
  b.box(Pose{}, Vec3(0.9, 0, z), Vec3(1.9, 0.06, z + 2.05), 0.45F);
  b.box(Pose{}, Vec3(1.0, kLength - 0.12, half + 2.1), Vec3(1.8, kLength, half + 2.25), kPlaster);
}

/// The way up in the middle of the flights, less `aside` to the left on each.
std::vector<Vec3> wayUp(double aside) {
  const double up = kFlightWidth / 2 - aside, back = kWidth - kFlightWidth / 2 + aside;
  const double low = kLanding / 2 + aside, high = kLength - kLanding / 2 - aside;
  std::vector<Vec3> way;
  for (int storey = 0; storey < kStoreys; ++storey) {
    const double z = storey * kStoreyHeight, half = z + kStoreyHeight / 2;
    way.insert(way.end(), {{up, low, z},
                           {up, kLanding, z},
                           {up, kLanding + kFlight, half},
                           {up, high, half},
                           {back, high, half},
                           {back, kLanding + kFlight, half},
                           {back, kLanding, z + kStoreyHeight},
                           {back, low, z + kStoreyHeight}});
  }
  return way;
}

}  // namespace

Scene makeStairwell() {
  MeshBuilder b;
  addWalls(b);
  for (int storey = 0; storey < kStoreys; ++storey) addStorey(b, storey * kStoreyHeight);
  Scene scene;
  scene.description = "a stairwell of three storeys, 2.8 x 5.9 x 12 m";
  scene.mesh = b.take();
  scene.route = wayUp(0.2);
  const std::vector<Vec3> down = wayUp(-0.2);
  scene.route.insert(scene.route.end(), down.rbegin(), down.rend());
  for (int storey = 0; storey <= kStoreys; ++storey) {
    const double z = storey * kStoreyHeight;
    scene.survey_stations.emplace_back(1.5, 0.8, z + 1.5);
    if (storey == kStoreys) continue;
    scene.survey_stations.emplace_back(1.4, kLength - 0.8, z + kStoreyHeight / 2 + 1.5);
  }
  return scene;
}

}  // namespace paloc::synth
