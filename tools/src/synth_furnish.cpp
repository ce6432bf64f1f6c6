#include "paloc/tools/synth_furnish.h"

#include "paloc/tools/synth_furniture.h"

namespace paloc::synth {
namespace {

constexpr double kHalfWall = 0.06;  // of inner walls (m)

}  // namespace

void addPieceByTheWall(MeshBuilder& b, const Pose& T, RandomStream& random) {
  const double kind = 6 * random.uniform();
  if (kind < 1) return addShelf(b, T, 1.6, 0.35, 1.9);
  if (kind < 2) return addCupboard(b, T, 1.2, 0.4, 1.8);
  if (kind < 3) return addSofa(b, T, 1.8);
  if (kind < 4) return addDesk(b, T);
  if (kind < 5) return addRadiator(b, T, 1.4);
  addPlant(b, T);
  addPanel(b, T * onFloor(0.4, 0.4), 0.8, 0.6, 1.5);
}

void furnishRoom(MeshBuilder& b, const Vec3& low, const Vec3& high, RandomStream& random) {
  const double middle_x = (low.x() + high.x()) / 2, middle_y = (low.y() + high.y()) / 2;
  const double x = middle_x + 0.8 * (random.uniform() - 0.5);
  const double y = middle_y + 0.8 * (random.uniform() - 0.5);
  const double yaw = 360 * random.uniform();
  addTable(b, onFloor(x, y, yaw), 1.6, 0.8);
  for (const double side : {0.0, 180.0}) {
    addChair(b, onFloor(x, y, yaw + side + 20 * random.normal()) * onFloor(0.3, -0.7, 180));
  }
  addBin(b, onFloor(low.x() + 0.4, low.y() + 0.4));
  // Along the four walls, a hand's breadth clear of them, and clear of the corners.
  const double gap = kHalfWall + 0.5;
  const double between = 0.3 + 0.4 * random.uniform();
  const double at_x = low.x() + between * (high.x() - low.x());
  const double at_y = low.y() + (1 - between) * (high.y() - low.y());
  addPieceByTheWall(b, onFloor(at_x, high.y() - gap, 0), random);
  addPieceByTheWall(b, onFloor(at_x, low.y() + gap, 180), random);
  addPieceByTheWall(b, onFloor(low.x() + gap, at_y, 90), random);
  addPieceByTheWall(b, onFloor(high.x() - gap, at_y, -90), random);
}

}  // namespace paloc::synth
