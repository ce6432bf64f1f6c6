#include "paloc/tools/synth_scene.h"

namespace paloc::synth {
namespace {

constexpr double kWallLength = 60, kWallHeight = 4, kWallThickness = 0.3;
constexpr float kBrick = 0.5F, kGround = 0.25F;

}  // namespace

Scene makeOpenField() {
  MeshBuilder b;
  b.box(Pose{}, Vec3(-55, -50, -0.2), Vec3(55, 20, 0), kGround);
  b.wall(onFloor(-kWallLength / 2, kWallThickness / 2), kWallLength, kWallThickness, kWallHeight,
         {}, kBrick);
  Scene scene;
  scene.description = "flat ground with one wall, 60 m long and 4 m high";
  scene.mesh = b.take();
  scene.route = {{-14, -4, 0}, {14, -5, 0}, {15, -12, 0}, {0, -9, 0}, {-15, -13, 0}};
  for (const double x : {-24.0, -12.0, 0.0, 12.0, 24.0}) {
    for (const double y : {-4.0, -12.0, -20.0}) scene.survey_stations.emplace_back(x, y, 1.7);
  }
  return scene;
}

}  // namespace paloc::synth
