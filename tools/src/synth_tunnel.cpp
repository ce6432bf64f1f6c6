#include <cmath>
#include <numbers>

#include "paloc/tools/synth_scene.h"

namespace paloc::synth {
namespace {

constexpr double kLength = 100, kRadius = 3.2, kAxisHeight = 1.8;
constexpr float kConcrete = 0.4F, kRoad = 0.15F;
constexpr int kPieces = 4096;  // of the vault, 4 mm each: its roughness is far below any noise

}  // namespace

Scene makeTunnel() {
  const double road_half_width = std::sqrt(kRadius * kRadius - kAxisHeight * kAxisHeight);
  const double from = -std::asin(kAxisHeight / kRadius), to = std::numbers::pi - from;
  std::vector<Vec3> vault;
  for (int i = 0; i <= kPieces; ++i) {
    const double angle = from + (to - from) * i / kPieces;
    vault.emplace_back(0, kRadius * std::cos(angle), kAxisHeight + kRadius * std::sin(angle));
  }
  MeshBuilder b;
  b.sweep(Pose{}, vault, Vec3(kLength, 0, 0), kConcrete);
  b.sweep(Pose{}, {Vec3(0, -road_half_width, 0), Vec3(0, road_half_width, 0)}, Vec3(kLength, 0, 0),
          kRoad);
  Scene scene;
  scene.description = "a smooth, bare tunnel, 100 m long, open at both ends";
  scene.mesh = b.take();
  scene.route = {{10, -0.9, 0}, {kLength - 10, -0.9, 0}, {kLength - 10, 0.9, 0}, {10, 0.9, 0}};
  constexpr int kStations = 10;
  for (int i = 0; i < kStations; ++i) {
    scene.survey_stations.emplace_back(kLength * (i + 0.5) / kStations, 0.1, 1.7);
  }
  return scene;
}

}  // namespace paloc::synth
