#include "paloc/tools/synth_changeables.h"
#include "paloc/tools/synth_mesh.h"

namespace paloc::synth {
namespace {

constexpr double kSill = 0.9, kWindow = 1.3;  // m, height of the sill and of the pane above it

}  // namespace

// Places are those of synth_building.cpp. None of it stands in the way of the walk.
Changeables buildingChangeables() {
  Changeables c;
  c.walls = {{"wall between N1 and N2", {{4.8, 8.65, -0.1}, {5.2, 15.1, 3.1}}, Vec3::UnitX()},
             {"wall between N3 and N4", {{17.85, 8.65, -0.1}, {18.15, 15.1, 3.1}}, -Vec3::UnitX()}};
  c.furniture = {{"table in S1", {{3.0, 2.8, -0.01}, {4.6, 3.8, 0.8}}},
                 {"desk and chair in N2", {{8.8, 10.0, -0.01}, {10.6, 11.6, 1.4}}},
                 {"cupboard in the corridor", {{13.3, 6.565, -0.01}, {14.9, 7.05, 2.0}}},
                 {"sofa in N3", {{12.065, 9.2, -0.01}, {13.0, 11.2, 1.0}}}};
  // Windows to the south and to the north, glass before a wall of the corridor and one in N2.
  for (const double x : {1.0, 4.2, 8.5, 11.2})
    c.panes.push_back({onFloor(x, 0, 0, kSill), 2, kWindow});
  for (const double x : {6.0, 9.0, 13.0}) c.panes.push_back({onFloor(x, 15, 0, kSill), 2, kWindow});
  c.panes.push_back({onFloor(1.4, 15, 0, kSill), 2.4, kWindow});
  c.panes.push_back({onFloor(7.2, 8.63, 0, 0.3), 4.2, 1.8});
  c.panes.push_back({onFloor(5.1, 10, 90, 0.5), 4, 1.8});
  c.missing = {{{-1, 8.67, -1}, {5.03, 16, 4}}};  // N1
  return c;
}

}  // namespace paloc::synth
