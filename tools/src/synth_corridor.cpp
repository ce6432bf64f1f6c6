#include <cmath>

#include "paloc/core/text.h"
#include "paloc/tools/synth_furniture.h"
#include "paloc/tools/synth_scene.h"

// The corridor's own frame: x along its axis from 0 to its length, y to the left, its middle at y =
// 0. A room stands at either end, open on its far side over the whole height: what is seen from the
// corridor through its ends is floor, ceiling and side walls, none of which fixes its axis.
namespace paloc::synth {
namespace {

constexpr double kHalfWidth = 1.2, kHeight = 2.6, kThickness = 0.2;
constexpr double kRoomDepth = 7, kRoomHalfWidth = 4, kRoomHeight = 3.2, kGateHalfWidth = 2.5;
constexpr double kStationEveryM = 8;
constexpr float kPlaster = 0.6F, kFloor = 0.3F;

void addCorridor(MeshBuilder& b, const Pose& T, double length_m) {
  b.box(T, Vec3(0, -kHalfWidth, -0.2), Vec3(length_m, kHalfWidth, 0), kFloor);
  b.box(T, Vec3(0, -kHalfWidth, kHeight), Vec3(length_m, kHalfWidth, kHeight + 0.2), kPlaster);
  for (const double side : {-1.0, 1.0}) {
    b.wall(T * onFloor(0, side * (kHalfWidth + kThickness / 2)), length_m, kThickness, kHeight, {},
           kPlaster);
  }
}

/// A room in its own frame: the corridor comes in at the origin, x leads further out.
void addRoom(MeshBuilder& b, const Pose& T) {
  b.box(T, Vec3(0, -kRoomHalfWidth, -0.2), Vec3(kRoomDepth, kRoomHalfWidth, 0), kFloor);
  b.box(T, Vec3(0, -kRoomHalfWidth, kRoomHeight),
        Vec3(kRoomDepth, kRoomHalfWidth, kRoomHeight + 0.2), kPlaster);
  const Pose T_scene_near = T * onFloor(kThickness / 2, -kRoomHalfWidth, 90);
  b.wall(T_scene_near, 2 * kRoomHalfWidth, kThickness, kRoomHeight,
         {{kRoomHalfWidth - kHalfWidth, kRoomHalfWidth + kHalfWidth, 0, kHeight}}, kPlaster);
  b.wall(T * onFloor(kRoomDepth, -kRoomHalfWidth, 90), 2 * kRoomHalfWidth, kThickness, kRoomHeight,
         {{kRoomHalfWidth - kGateHalfWidth, kRoomHalfWidth + kGateHalfWidth, 0, kRoomHeight}},
         kPlaster);
  for (const double side : {-1.0, 1.0}) {
    b.wall(T * onFloor(0, side * (kRoomHalfWidth + kThickness / 2)), kRoomDepth, kThickness,
           kRoomHeight, {}, kPlaster);
  }
  addDesk(b, T * onFloor(2.0, 3.5));
  addCupboard(b, T * onFloor(4.8, 3.75), 1.4, 0.45, 2.0);
  addShelf(b, T * onFloor(2.2, -3.8, 180), 2.0, 0.35, 2.1);
  addSofa(b, T * onFloor(4.8, -3.4, 180), 1.9);
  addPlant(b, T * onFloor(0.6, 3.3));
  addBin(b, T * onFloor(0.5, -3.0));
  addLamp(b, T * onFloor(2.5, 3.2), 1.3, 0.3, kRoomHeight);
  addLamp(b, T * onFloor(4.5, -3.2), 1.3, 0.3, kRoomHeight);
}

}  // namespace

Scene makeCorridor(double yaw_deg, double length_m) {
  const Pose T_scene_corridor = onFloor(0, 0, yaw_deg);
  MeshBuilder b;
  addCorridor(b, T_scene_corridor, length_m);
  addRoom(b, T_scene_corridor * onFloor(0, 0, 180));
  addRoom(b, T_scene_corridor * onFloor(length_m, 0));
  Scene scene;
  scene.description = text("a bare corridor, ", std::lround(length_m),
                           " x 2.4 x 2.6 m, between two furnished rooms");
  scene.mesh = b.take();
  for (const Vec3& p : std::initializer_list<Vec3>{{-5.2, 1.2, 0},
                                                   {-5.2, -1.2, 0},
                                                   {-2, -1, 0},
                                                   {0.5, -0.3, 0},
                                                   {length_m - 0.5, -0.3, 0},
                                                   {length_m + 2, -1, 0},
                                                   {length_m + 5.2, -1.2, 0},
                                                   {length_m + 5.2, 1.2, 0},
                                                   {length_m + 2, 1, 0},
                                                   {length_m - 0.5, 0.3, 0},
                                                   {0.5, 0.3, 0},
                                                   {-2, 1, 0}}) {
    scene.route.push_back(T_scene_corridor * p);
  }
  for (const double x : {-4.0, length_m + 4.0}) {
    for (const double y : {-1.5, 1.5}) {
      scene.survey_stations.push_back(T_scene_corridor * Vec3(x, y, 1.6));
    }
  }
  const int stations = static_cast<int>(std::ceil(length_m / kStationEveryM));
  for (int i = 0; i < stations; ++i) {
    const double x = length_m * (i + 0.5) / stations;
    scene.survey_stations.push_back(T_scene_corridor * Vec3(x, 0.1, 1.5));
  }
  return scene;
}

}  // namespace paloc::synth
