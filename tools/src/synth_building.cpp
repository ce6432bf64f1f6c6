#include "paloc/tools/synth_furnish.h"
#include "paloc/tools/synth_furniture.h"
#include "paloc/tools/synth_scene.h"

// The floor: x to the east from 0 to 25 m, y to the north from 0 to 15 m, 3 m high. A corridor
// along x (y 6.5 to 8.7) with three rooms to the south (S1 to S3) and four to the north (N1 to N4).
namespace paloc::synth {
namespace {

constexpr double kHeight = 3.0;
constexpr double kOuter = 0.25, kInner = 0.12;  // thickness of walls
constexpr double kDoorTop = 2.05, kSill = 0.9, kWindowTop = 2.2;
constexpr float kPlaster = 0.7F, kFloor = 0.3F, kConcrete = 0.4F;

struct Point2 {
  double x, y;
};

// clang-format off
constexpr Point2 kRoute[] = {
    {2.0, 3.3}, {3.4, 2.2}, {5.2, 2.4}, {6.075, 4.0}, {6.075, 5.5},                     // S1
    {6.075, 6.5}, {6.0, 7.3}, {5.0, 7.6}, {4.0, 7.6}, {3.675, 8.0},                     // corridor
    {3.675, 8.7}, {3.675, 9.7}, {3.9, 11.6}, {3.5, 13.5}, {2.3, 13.75}, {1.3, 12.6},    // N1
    {1.35, 11.1}, {2.2, 10.4}, {3.2, 10.2}, {3.675, 9.5}, {3.675, 8.7},
    {3.9, 7.6}, {5.2, 7.45}, {6.3, 7.7},
    {6.475, 8.7}, {6.475, 9.7}, {6.6, 11.6}, {8.0, 12.5}, {9.6, 13.3}, {11.2, 13.475},  // N2
    {12.0, 13.475}, {12.8, 13.475}, {14.2, 13.1}, {15.3, 11.8}, {16.6, 10.6}, {16.675, 9.7},    // N3
    {16.675, 8.7}, {16.9, 7.6}, {18.2, 7.45}, {19.3, 7.7},
    {19.475, 8.7}, {19.475, 9.7}, {19.35, 12.0}, {19.5, 13.9}, {21.1, 14.1}, {22.0, 12.2},      // N4
    {21.8, 10.2}, {20.6, 9.7}, {19.6, 9.4}, {19.475, 8.7},
    {19.8, 7.6}, {21.5, 7.5}, {23.2, 7.45},
    {23.5, 6.5}, {23.5, 5.5}, {23.3, 3.6}, {22.3, 1.9}, {20.2, 2.0}, {18.6, 3.4}, {17.1, 4.9},  // S3
    {15.4, 5.275}, {14.0, 5.275}, {13.1, 5.2}, {13.15, 3.6}, {12.9, 1.4}, {11.0, 0.85},         // S2
    {8.6, 1.0}, {8.15, 2.8}, {8.5, 4.6}, {8.875, 5.5},
    {8.875, 6.5}, {8.6, 7.4}, {7.3, 7.6}, {6.3, 7.3},
    {6.075, 6.5}, {6.0, 5.5}, {5.2, 4.6}, {3.6, 4.5}};
constexpr Point2 kStations[] = {
    {5.0, 4.0}, {1.9, 2.6}, {12.9, 4.7}, {8.2, 1.5}, {22.6, 5.2}, {17.6, 4.6}, {19.0, 2.0}, {3.9, 10.6},
    {7.6, 11.4}, {15.8, 12.6}, {19.4, 10.8}, {22.0, 13.6}, {24.1, 11.6}, {2.0, 7.6}, {12.0, 7.5}, {22.0, 7.6}};
constexpr Point2 kLamps[] = {
    {2.2, 2.2}, {5.2, 2.2}, {2.2, 4.6}, {5.2, 4.6}, {9.6, 2.9}, {11.8, 2.9}, {15.6, 3.2}, {19.2, 1.8},
    {19.2, 4.8}, {23.2, 3.2}, {2.5, 10.6}, {2.5, 13.2}, {7.0, 11.8}, {10.0, 11.8}, {13.6, 11.8}, {16.4, 11.8},
    {19.4, 11.8}, {22.0, 11.8}};
// clang-format on
// Between the middles of the walls: S1 to S3, N1 to N4.
const Region kRooms[] = {{{0, 0, 0}, {7.5, 6.5, kHeight}}, {{7.5, 0, 0}, {14, 6.5, kHeight}},
                         {{14, 0, 0}, {25, 6.5, kHeight}}, {{0, 8.7, 0}, {5, 15, kHeight}},
                         {{5, 8.7, 0}, {12, 15, kHeight}}, {{12, 8.7, 0}, {18, 15, kHeight}},
                         {{18, 8.7, 0}, {25, 15, kHeight}}};

struct Door {
  double from, to;
  double leaf_deg;
};

void wallWithDoors(MeshBuilder& b, const Pose& T, double length, const std::vector<Door>& doors) {
  std::vector<WallOpening> openings;
  for (const Door& door : doors) openings.push_back({door.from, door.to, 0, kDoorTop});
  b.wall(T, length, kInner, kHeight, openings, kPlaster);
  for (std::size_t i = 0; i < doors.size(); ++i) {
    addDoor(b, T, openings[i], kInner, doors[i].leaf_deg);
  }
}

/// Windows as pairs (from, to) along the wall, each with a radiator below.
void wallWithWindows(MeshBuilder& b, const Pose& T, double length,
                     const std::vector<std::pair<double, double>>& windows, bool radiators) {
  std::vector<WallOpening> openings;
  for (const auto& [from, to] : windows) openings.push_back({from, to, kSill, kWindowTop});
  b.wall(T, length, kOuter, kHeight, openings, kPlaster);
  for (const WallOpening& opening : openings) {
    addWindow(b, T, opening, kOuter);
    const double middle = (opening.from_m + opening.to_m) / 2;
    if (radiators) addRadiator(b, T * onFloor(middle, kOuter / 2 + 0.06, 180), 1.4);
  }
}

void addShell(MeshBuilder& b) {
  b.box(Pose{}, Vec3(-0.3, -0.3, -0.2), Vec3(25.3, 15.3, 0), kFloor);
  b.box(Pose{}, Vec3(-0.3, -0.3, kHeight), Vec3(25.3, 15.3, kHeight + 0.2), kPlaster);
  // Outer walls; along each its own x, with the inside to its left.
  wallWithWindows(b, onFloor(0, -kOuter / 2), 25,
                  {{1, 3}, {4.2, 6.2}, {8.5, 10.5}, {11.2, 13.2}, {15, 17}, {18, 20}, {21.4, 23.4}},
                  true);
  wallWithWindows(b, onFloor(25, 15 + kOuter / 2, 180), 25,
                  {{4, 6}, {7.6, 9.2}, {10, 12}, {14, 16}, {17, 19}, {21.2, 23.6}}, true);
  wallWithWindows(b, onFloor(-kOuter / 2, 15 + kOuter, -90), 15 + 2 * kOuter, {{7.15, 8.25}},
                  false);
  wallWithWindows(b, onFloor(25 + kOuter / 2, -kOuter, 90), 15 + 2 * kOuter, {{3, 5}, {11, 12.5}},
                  false);
  // Corridor, then the walls between rooms.
  wallWithDoors(b, onFloor(0, 6.5), 25,
                {{5.6, 6.55, -105}, {8.4, 9.35, -100}, {15.5, 16.45, -95}, {23, 24, -110}});
  wallWithDoors(b, onFloor(0, 8.7), 25,
                {{3.2, 4.15, 105}, {6, 6.95, 108}, {16.2, 17.15, 98}, {19, 19.95, 112}});
  wallWithDoors(b, onFloor(7.5, 0, 90), 6.5, {});
  wallWithDoors(b, onFloor(14, 0, 90), 6.5, {{4.8, 5.75, 0}});
  wallWithDoors(b, onFloor(5, 8.7, 90), 6.3, {});
  wallWithDoors(b, onFloor(12, 8.7, 90), 6.3, {{4.3, 5.25, 0}});
  wallWithDoors(b, onFloor(18, 8.7, 90), 6.3, {});
}

void addCeiling(MeshBuilder& b) {
  for (const double x : {6.95, 12.9, 18.3}) {
    b.box(onFloor(x, 7.6), Vec3(-0.15, -1.1, 2.65), Vec3(0.15, 1.1, kHeight), kConcrete);
  }
  for (const double x : {17.3, 21.0}) {
    b.box(onFloor(x, 3.2), Vec3(-0.15, -3.25, 2.68), Vec3(0.15, 3.25, kHeight), kConcrete);
  }
  b.box(Pose{}, Vec3(0.05, 8.2, 2.55), Vec3(24.9, 8.45, 2.62), 0.5F);  // cable tray
  for (double x = 2; x < 25; x += 4.2) addLamp(b, onFloor(x, 7.4), 1.2, 0.2, kHeight);
  for (const Point2& p : kLamps) addLamp(b, onFloor(p.x, p.y), 1.3, 0.3, kHeight);
}

void addCorridor(MeshBuilder& b) {
  addTable(b, onFloor(12, 8.4), 1.6, 0.4, 0.45);
  addCupboard(b, onFloor(14.1, 6.77, 180), 1.4, 0.4, 1.9);
  addTable(b, onFloor(10.7, 6.86), 1.0, 0.55);
  b.box(onFloor(10.7, 6.86), Vec3(-0.3, -0.22, 0.74), Vec3(0.3, 0.22, 1.08), 0.6F);  // printer
  b.cylinder(onFloor(7.9, 6.68), 0.08, 0.08, 0.5, 1.1, 0.2F);                        // extinguisher
  b.cylinder(onFloor(22.2, 8.52), 0.08, 0.08, 0.5, 1.1, 0.2F);
  addPlant(b, onFloor(0.45, 8.2));
  addPlant(b, onFloor(24.55, 7.0));
  addPanel(b, onFloor(14.5, 8.62), 1.4, 1.0, 1.5);
  addPanel(b, onFloor(1.8, 6.58, 180), 0.9, 1.2, 1.6);
  addPanel(b, onFloor(20.5, 6.58, 180), 1.2, 0.8, 1.6);
  addBin(b, onFloor(12.95, 8.42));
  b.box(onFloor(9.7, 8.6), Vec3(-0.3, -0.12, 0.9), Vec3(0.3, 0.04, 1.6), 0.3F);  // fire hose
  b.box(onFloor(24.98, 7.6), Vec3(-0.03, -0.5, 0), Vec3(0, 0.5, 2.1), 0.45F);    // emergency exit
}

void addOfficeS1(MeshBuilder& b) {
  addDesk(b, onFloor(1.6, 0.62, 180));
  addDesk(b, onFloor(4.3, 0.62, 180));
  addDesk(b, onFloor(0.42, 4.9, 90));
  addCupboard(b, onFloor(2.8, 6.2), 1.6, 0.45, 2.0);
  addShelf(b, onFloor(7.25, 2.0, -90), 2.2, 0.35, 2.1);
  addTable(b, onFloor(3.8, 3.3), 1.4, 0.8);
  addPlant(b, onFloor(7.05, 5.9));
  addBin(b, onFloor(2.75, 0.5));
}

void addMeetingRoomS2(MeshBuilder& b) {
  addTable(b, onFloor(10.7, 2.9), 3.2, 1.3);
  int turn = 0;
  for (const double x : {9.6, 10.7, 11.8}) {
    addChair(b, onFloor(x, 3.9, 8 - 9 * turn));
    addChair(b, onFloor(x + 0.05, 1.95, 170 + 11 * turn));
    ++turn;
  }
  addPanel(b, onFloor(7.58, 3.0, 90), 2.4, 1.2, 1.5);
  addCupboard(b, onFloor(11.6, 6.2), 2.4, 0.42, 0.8);
  addPanel(b, onFloor(11.6, 6.42), 1.3, 0.75, 1.6);
  addPlant(b, onFloor(13.5, 0.5));
}

void addLabS3(MeshBuilder& b) {
  b.cylinder(onFloor(19.5, 4.6), 0.25, 0.25, 0, kHeight, kConcrete);
  b.cylinder(onFloor(16.6, 3.4), 0.25, 0.25, 0, kHeight, kConcrete);
  addTable(b, onFloor(16.3, 1.3, 25), 2.2, 0.9, 0.9);
  b.box(onFloor(16.3, 1.3, 25), Vec3(-0.8, -0.2, 0.9), Vec3(-0.2, 0.3, 1.4), 0.3F);
  b.cylinder(onFloor(16.9, 1.55), 0.14, 0.1, 0.9, 1.3, 0.5F);
  addTable(b, onFloor(20.2, 0.66), 2.4, 0.8, 0.9);
  b.box(onFloor(20.2, 0.66), Vec3(-0.9, -0.25, 0.9), Vec3(-0.3, 0.25, 1.25), 0.6F);
  addDesk(b, onFloor(24.4, 2.0, -90));
  addTable(b, onFloor(21.3, 4.2), 1.8, 0.9);
  addChair(b, onFloor(20.9, 4.9, 12));
  addChair(b, onFloor(21.7, 3.5, 200));
  addCupboard(b, onFloor(18.2, 6.17), 1.4, 0.5, 1.7);
  addCupboard(b, onFloor(20.2, 6.17), 0.9, 0.5, 2.1);
  addShelf(b, onFloor(14.28, 1.5, 90), 2.0, 0.4, 2.0);
  addBin(b, onFloor(24.6, 5.9));
}

void addKitchenN1(MeshBuilder& b) {
  addCupboard(b, onFloor(0.31, 12.4, 90), 3.4, 0.6, 0.9);
  b.box(onFloor(0.19, 12.4, 90), Vec3(-1.5, -0.18, 1.5), Vec3(1.5, 0.18, 2.2), 0.7F);
  addCupboard(b, onFloor(0.37, 14.58, 90), 0.7, 0.7, 1.9);
  addTable(b, onFloor(2.6, 11.9), 1.2, 0.8);
  addChair(b, onFloor(2.55, 12.55, 5));
  addChair(b, onFloor(2.7, 11.25, 188));
  addPlant(b, onFloor(4.5, 14.4));
  addBin(b, onFloor(4.65, 9.1));
  addPanel(b, onFloor(4.92, 12.0, -90), 1.1, 0.8, 1.6);
}

void addOfficeN2(MeshBuilder& b) {
  addDesk(b, onFloor(6.3, 14.38));
  addDesk(b, onFloor(8.5, 14.38));
  addDesk(b, onFloor(9.7, 10.5, 180));
  addCupboard(b, onFloor(8.5, 9.0, 180), 1.8, 0.45, 1.2);
  addShelf(b, onFloor(11.75, 10.6, -90), 2.0, 0.35, 2.0);
  addPanel(b, onFloor(5.08, 12, 90), 1.6, 1.0, 1.5);
  addPlant(b, onFloor(11.5, 12.2));
  addBin(b, onFloor(7.4, 14.6));
}

void addOfficeN3(MeshBuilder& b) {
  addSofa(b, onFloor(12.52, 10.2, 90), 1.9);
  addTable(b, onFloor(13.7, 10.2, 90), 1.0, 0.6, 0.45);
  addDesk(b, onFloor(17.5, 13.3, -90));
  addDesk(b, onFloor(14.9, 14.38));
  addCupboard(b, onFloor(14.3, 9.0, 180), 2.2, 0.45, 2.0);
  b.box(onFloor(13.4, 11.8, 20), Vec3(-0.6, -0.03, 0.05), Vec3(0.6, 0.03, 1.6), 0.35F);  // screen
  addPanel(b, onFloor(17.92, 11.2, -90), 1.5, 1.0, 1.5);
  addPlant(b, onFloor(12.5, 14.5));
}

void addLibraryN4(MeshBuilder& b) {
  addShelf(b, onFloor(20.6, 11.9, 90), 2.6, 0.4, 2.1);
  addShelf(b, onFloor(23.2, 11.9, -90), 3.0, 0.4, 2.1);
  addShelf(b, onFloor(18.25, 12.2, 90), 3.0, 0.35, 2.1);
  addShelf(b, onFloor(24.8, 10.2, -90), 1.6, 0.35, 2.1);
  addCupboard(b, onFloor(23.2, 9.0, 180), 2.0, 0.45, 2.2);
  addTable(b, onFloor(23.4, 14.3), 1.6, 0.7);
  addChair(b, onFloor(23.4, 13.8, 170));
  addPlant(b, onFloor(18.5, 14.5));
}

Scene walkedAndSurveyed(MeshBuilder& b) {
  Scene scene;
  scene.mesh = b.take();
  for (const Point2& p : kRoute) scene.route.emplace_back(p.x, p.y, 0);
  for (const Point2& p : kStations) scene.survey_stations.emplace_back(p.x, p.y, 1.6);
  return scene;
}

}  // namespace

Scene makeBuilding() {
  MeshBuilder b;
  addShell(b);
  addCeiling(b);
  addCorridor(b);
  addOfficeS1(b);
  addMeetingRoomS2(b);
  addLabS3(b);
  addKitchenN1(b);
  addOfficeN2(b);
  addOfficeN3(b);
  addLibraryN4(b);
  Scene scene = walkedAndSurveyed(b);
  scene.description =
      "a floor of an office building, 25 x 15 x 3 m: seven furnished rooms on a corridor";
  scene.changeables = buildingChangeables();
  return scene;
}

Scene makeBuildingStorey(std::uint64_t storey) {
  MeshBuilder b;
  addShell(b);
  addCeiling(b);
  RandomStream random(storey, RandomPurpose::kRooms, 1);
  for (const double x : {10.7, 14.3, 20.5}) {
    addPieceByTheWall(b, onFloor(x + random.uniform(), 8.7 - 0.3), random);
    addPieceByTheWall(b, onFloor(x + random.uniform(), 6.5 + 0.3, 180), random);
  }
  for (const Region& room : kRooms) furnishRoom(b, room.low, room.high, random);
  Scene scene = walkedAndSurveyed(b);
  scene.name = "building-storey-" + std::to_string(storey);
  scene.description = "another storey of the building: the same walls, other furniture";
  return scene;
}

}  // namespace paloc::synth
