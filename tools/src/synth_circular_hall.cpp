#include <cmath>
#include <numbers>

#include "paloc/tools/synth_scene.h"

namespace paloc::synth {
namespace {

constexpr double kRadius = 12, kHeight = 5;
constexpr float kPlaster = 0.6F, kFloor = 0.3F;
constexpr int kPieces = 8192;  // of the wall, 9 mm each: its roughness is far below any noise

}  // namespace

Scene makeCircularHall() {
  std::vector<Vec3> circle;
  for (int i = 0; i <= kPieces; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPieces;
    circle.emplace_back(kRadius * std::cos(angle), kRadius * std::sin(angle), 0);
  }
  constexpr double kOut = kRadius + 0.2;
  MeshBuilder b;
  b.sweep(Pose{}, circle, Vec3(0, 0, kHeight), kPlaster);
  b.box(Pose{}, Vec3(-kOut, -kOut, -0.2), Vec3(kOut, kOut, 0), kFloor);
  b.box(Pose{}, Vec3(-kOut, -kOut, kHeight), Vec3(kOut, kOut, kHeight + 0.2), kPlaster);
  Scene scene;
  scene.description = "a bare round hall of 12 m radius, 5 m high";
  scene.mesh = b.take();
  scene.route = {{8, 0, 0},   {5, 6, 0},   {-2, 8, 0}, {-4, 3, 0},
                 {-8, -2, 0}, {-3, -8, 0}, {3, -5, 0}};
  scene.survey_stations = {{0, 0, 1.7}, {6, 1, 1.7}, {-5, 4, 1.7}, {-2, -6, 1.7}};
  return scene;
}

}  // namespace paloc::synth
