#include "paloc/tools/synth_furniture.h"
#include "paloc/tools/synth_scene.h"

namespace paloc::synth {
namespace {

constexpr double kLength = 8, kWidth = 6, kHeight = 3, kThickness = 0.2;
constexpr float kPlaster = 0.7F, kFloor = 0.3F;

void addShell(MeshBuilder& b) {
  b.box(Pose{}, Vec3(-0.2, -0.2, -0.2), Vec3(kLength + 0.2, kWidth + 0.2, 0), kFloor);
  b.box(Pose{}, Vec3(-0.2, -0.2, kHeight), Vec3(kLength + 0.2, kWidth + 0.2, kHeight + 0.2),
        kPlaster);
  const double outer = kThickness / 2;
  b.wall(onFloor(0, -outer), kLength, kThickness, kHeight, {}, kPlaster);
  b.wall(onFloor(0, kWidth + outer), kLength, kThickness, kHeight, {}, kPlaster);
  b.wall(onFloor(-outer, 0, 90), kWidth, kThickness, kHeight, {}, kPlaster);
  b.wall(onFloor(kLength + outer, 0, 90), kWidth, kThickness, kHeight, {}, kPlaster);
}

}  // namespace

Scene makeRoom() {
  MeshBuilder b;
  addShell(b);
  addDesk(b, onFloor(1.5, 5.5));
  addDesk(b, onFloor(4.2, 5.5));
  addCupboard(b, onFloor(7.7, 4.5, -90), 1.6, 0.5, 2.0);
  addShelf(b, onFloor(0.25, 1.6, 90), 2.0, 0.35, 2.1);
  addTable(b, onFloor(4.0, 3.0), 1.6, 0.8);
  addChair(b, onFloor(3.6, 3.6, 10));
  addSofa(b, onFloor(6.0, 0.5, 180), 1.9);
  addPlant(b, onFloor(7.5, 0.5));
  addLamp(b, onFloor(2.5, 3), 1.3, 0.3, kHeight);
  addLamp(b, onFloor(5.5, 3), 1.3, 0.3, kHeight);
  Scene scene;
  scene.description = "a furnished room, 8 x 6 x 3 m";
  scene.mesh = b.take();
  scene.route = {{1.5, 1.5, 0}, {4.0, 1.7, 0}, {6.2, 1.9, 0}, {6.6, 3.0, 0},
                 {5.9, 4.2, 0}, {3.6, 4.4, 0}, {1.6, 3.6, 0}};
  scene.survey_stations = {{2, 1.8, 1.6}, {6.3, 2.6, 1.6}, {2.4, 4.1, 1.6}};
  return scene;
}

}  // namespace paloc::synth
