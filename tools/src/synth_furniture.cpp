#include "paloc/tools/synth_furniture.h"

#include <cmath>

namespace paloc::synth {
namespace {

constexpr float kWood = 0.45F;
constexpr float kWhite = 0.75F;
constexpr float kDark = 0.12F;
constexpr float kMetal = 0.55F;
constexpr float kFabric = 0.25F;

/// A box that stands on height z, in the middle of (x, y).
void block(MeshBuilder& builder, const Pose& T, double x, double y, double z, const Vec3& size,
           float reflectivity) {
  builder.box(T, Vec3(x - size.x() / 2, y - size.y() / 2, z),
              Vec3(x + size.x() / 2, y + size.y() / 2, z + size.z()), reflectivity);
}

void legs(MeshBuilder& builder, const Pose& T, double width, double depth, double height,
          double thickness) {
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      block(builder, T, x * (width - thickness) / 2, y * (depth - thickness) / 2, 0,
            Vec3(thickness, thickness, height), kMetal);
    }
  }
}

}  // namespace

void addTable(MeshBuilder& builder, const Pose& T, double width, double depth, double height) {
  block(builder, T, 0, 0, height - 0.03, Vec3(width, depth, 0.03), kWood);
  legs(builder, T, width - 0.06, depth - 0.06, height - 0.03, 0.05);
}

void addDesk(MeshBuilder& builder, const Pose& T) {
  addTable(builder, T, 1.6, 0.8);
  block(builder, T, 0.55, 0.05, 0, Vec3(0.42, 0.6, 0.58), kWhite);
  block(builder, T, -0.1, 0.2, 0.86, Vec3(0.6, 0.04, 0.36), kDark);
  block(builder, T, -0.1, 0.24, 0.74, Vec3(0.22, 0.18, 0.12), kDark);
  addChair(builder, T * Pose{Vec3(-0.1, -0.65, 0), so3::exp(Vec3(0, 0, 3.4))});
}

void addChair(MeshBuilder& builder, const Pose& T) {
  block(builder, T, 0, 0, 0.42, Vec3(0.46, 0.46, 0.06), kFabric);
  block(builder, T, 0, 0.22, 0.52, Vec3(0.44, 0.05, 0.42), kFabric);
  legs(builder, T, 0.42, 0.42, 0.42, 0.035);
}

void addSofa(MeshBuilder& builder, const Pose& T, double width) {
  block(builder, T, 0, 0, 0.05, Vec3(width, 0.85, 0.37), kFabric);
  block(builder, T, 0, 0.32, 0.42, Vec3(width, 0.2, 0.38), kFabric);
  for (const double side : {-1.0, 1.0}) {
    block(builder, T, side * (width - 0.16) / 2, -0.1, 0.42, Vec3(0.16, 0.64, 0.18), kFabric);
  }
}

void addShelf(MeshBuilder& builder, const Pose& T, double width, double depth, double height) {
  constexpr double kBoard = 0.025;
  for (const double side : {-1.0, 1.0}) {
    block(builder, T, side * (width - kBoard) / 2, 0, 0, Vec3(kBoard, depth, height), kWood);
  }
  const int boards = std::max(2, static_cast<int>(std::lround(height / 0.4)));
  const double step = (height - kBoard) / boards;
  for (int i = 0; i <= boards; ++i) {
    block(builder, T, 0, 0, i * step, Vec3(width - 2 * kBoard, depth, kBoard), kWood);
    if (i == boards) continue;
    // What stands on the board: two stacks whose sizes differ from board to board.
    const double a = 0.2 + 0.07 * (i % 3), b = 0.25 + 0.05 * ((i + 1) % 4);
    block(builder, T, -width / 2 + 0.08 + a / 2, 0.02, i * step + kBoard,
          Vec3(a, 0.7 * depth, 0.5 * step + 0.04 * (i % 2)), kWhite);
    block(builder, T, width / 2 - 0.12 - b / 2, 0, i * step + kBoard,
          Vec3(b, 0.6 * depth, 0.6 * step), i % 2 ? kDark : kWood);
  }
}

void addCupboard(MeshBuilder& builder, const Pose& T, double width, double depth, double height) {
  block(builder, T, 0, 0, 0.08, Vec3(width, depth, height - 0.08), kWhite);
  block(builder, T, 0, 0.02, 0, Vec3(width - 0.04, depth - 0.08, 0.08), kDark);
  for (const double side : {-1.0, 1.0}) {
    block(builder, T, side * 0.06, -depth / 2 - 0.015, height * 0.5, Vec3(0.02, 0.03, 0.15),
          kMetal);
  }
}

void addPlant(MeshBuilder& builder, const Pose& T) {
  builder.cylinder(T, 0.15, 0.2, 0, 0.35, kDark);
  builder.cylinder(T, 0.02, 0.02, 0.35, 0.8, kWood);
  builder.cylinder(T, 0.32, 0.05, 0.7, 1.5, kFabric);
}

void addBin(MeshBuilder& builder, const Pose& T) {
  builder.cylinder(T, 0.13, 0.16, 0, 0.38, kMetal);
}

void addLamp(MeshBuilder& builder, const Pose& T, double width, double depth, double ceiling) {
  block(builder, T, 0, 0, ceiling - 0.35, Vec3(width, depth, 0.07), kWhite);
  for (const double side : {-0.4, 0.4}) {
    block(builder, T, side * width, 0, ceiling - 0.28, Vec3(0.015, 0.015, 0.28), kMetal);
  }
}

void addPanel(MeshBuilder& builder, const Pose& T, double width, double height, double z) {
  block(builder, T, 0, 0, z - height / 2, Vec3(width, 0.03, height), kWhite);
}

void addDoor(MeshBuilder& builder, const Pose& T_scene_wall, const WallOpening& opening,
             double thickness, double leaf_deg) {
  constexpr double kBar = 0.06;
  const double depth = thickness + 0.04, middle = (opening.from_m + opening.to_m) / 2;
  for (const double x : {opening.from_m, opening.to_m}) {
    block(builder, T_scene_wall, x, 0, 0, Vec3(kBar, depth, opening.top_m), kMetal);
  }
  block(builder, T_scene_wall, middle, 0, opening.top_m - kBar / 2,
        Vec3(opening.to_m - opening.from_m + kBar, depth, kBar), kMetal);
  if (leaf_deg == 0) return;
  const double side = leaf_deg > 0 ? 1 : -1;
  const Pose T_scene_hinge =
      T_scene_wall * onFloor(opening.from_m + 0.01, side * depth / 2, leaf_deg);
  const double width = opening.to_m - opening.from_m - kBar;
  block(builder, T_scene_hinge, width / 2, 0, 0.01, Vec3(width, 0.04, opening.top_m - 0.06), kWood);
  block(builder, T_scene_hinge, width - 0.08, 0, 1.02, Vec3(0.12, 0.14, 0.03), kMetal);
}

void addWindow(MeshBuilder& builder, const Pose& T_scene_wall, const WallOpening& opening,
               double thickness) {
  constexpr double kBar = 0.07;
  const double width = opening.to_m - opening.from_m, height = opening.top_m - opening.bottom_m;
  const double middle = (opening.from_m + opening.to_m) / 2;
  for (const double x : {opening.from_m + kBar / 2, middle, opening.to_m - kBar / 2}) {
    block(builder, T_scene_wall, x, 0, opening.bottom_m, Vec3(kBar, 0.08, height), kWhite);
  }
  for (const double z : {opening.bottom_m, opening.top_m - kBar}) {
    block(builder, T_scene_wall, middle, 0, z, Vec3(width, 0.08, kBar), kWhite);
  }
  block(builder, T_scene_wall, middle, thickness / 2 + 0.05, opening.bottom_m - 0.03,
        Vec3(width + 0.1, 0.24, 0.03), kWhite);
}

void addRadiator(MeshBuilder& builder, const Pose& T, double width) {
  block(builder, T, 0, 0, 0.12, Vec3(width, 0.08, 0.6), kWhite);
  const int ribs = static_cast<int>(width / 0.2);
  for (int i = 0; i < ribs; ++i) {
    block(builder, T, -width / 2 + 0.1 + 0.2 * i, -0.055, 0.14, Vec3(0.06, 0.03, 0.56), kWhite);
  }
}

}  // namespace paloc::synth
