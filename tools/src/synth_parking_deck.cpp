#include "paloc/tools/synth_scene.h"

namespace paloc::synth {
namespace {

constexpr double kLength = 48, kWidth = 30, kHeight = 2.8;
constexpr double kParapetHeight = 1.1, kThickness = 0.25, kPillar = 0.5;
constexpr float kConcrete = 0.4F, kAsphalt = 0.2F;

}  // namespace

Scene makeParkingDeck() {
  MeshBuilder b;
  b.box(Pose{}, Vec3(0, 0, -0.3), Vec3(kLength, kWidth, 0), kAsphalt);
  b.box(Pose{}, Vec3(0, 0, kHeight), Vec3(kLength, kWidth, kHeight + 0.3), kConcrete);
  const double inner = kThickness / 2;
  b.wall(onFloor(0, inner), kLength, kThickness, kParapetHeight, {}, kConcrete);
  b.wall(onFloor(0, kWidth - inner), kLength, kThickness, kParapetHeight, {}, kConcrete);
  b.wall(onFloor(inner, 0, 90), kWidth, kThickness, kParapetHeight, {}, kConcrete);
  b.wall(onFloor(kLength - inner, 0, 90), kWidth, kThickness, kParapetHeight, {}, kConcrete);
  for (double x = 4; x < kLength; x += 8) {
    for (double y = 5; y < kWidth; y += 10) {
      b.box(onFloor(x, y), Vec3(-kPillar / 2, -kPillar / 2, 0),
            Vec3(kPillar / 2, kPillar / 2, kHeight), kConcrete);
    }
  }
  Scene scene;
  scene.description =
      "a parking deck, 48 x 30 x 2.8 m: pillars, parapets, a flat floor and ceiling";
  scene.mesh = b.take();
  scene.route = {{6, 10, 0},    {24, 10.5, 0}, {42, 9.5, 0},
                 {42.5, 20, 0}, {24, 19.5, 0}, {6, 20.5, 0}};
  for (const double x : {8.0, 24.0, 40.0}) {
    for (const double y : {7.5, 15.0, 22.5}) scene.survey_stations.emplace_back(x, y, 1.6);
  }
  for (const double x : {16.0, 32.0}) {
    for (const double y : {10.0, 20.0}) scene.survey_stations.emplace_back(x, y, 1.5);
  }
  return scene;
}

}  // namespace paloc::synth
