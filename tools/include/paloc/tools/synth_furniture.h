#pragma once

#include "paloc/tools/synth_mesh.h"

/// Things that stand in scenes. A piece's frame: its origin on the floor in the middle of its
/// footprint, x to its right, y away from its front (a cupboard's back is at +y). Sizes in m.
namespace paloc::synth {

void addTable(MeshBuilder& builder, const Pose& T_scene_piece, double width, double depth,
              double height = 0.74);
/// A table with a screen and a pedestal of drawers, and a chair before it.
void addDesk(MeshBuilder& builder, const Pose& T_scene_piece);
void addChair(MeshBuilder& builder, const Pose& T_scene_piece);
void addSofa(MeshBuilder& builder, const Pose& T_scene_piece, double width);
/// Open shelves with boards, and some boxes on them.
void addShelf(MeshBuilder& builder, const Pose& T_scene_piece, double width, double depth,
              double height);
void addCupboard(MeshBuilder& builder, const Pose& T_scene_piece, double width, double depth,
                 double height);
void addPlant(MeshBuilder& builder, const Pose& T_scene_piece);
void addBin(MeshBuilder& builder, const Pose& T_scene_piece);
/// A lamp that hangs below a ceiling at `ceiling`.
void addLamp(MeshBuilder& builder, const Pose& T_scene_piece, double width, double depth,
             double ceiling);
/// A flat panel on a wall: a board or a picture; its middle at height `z`.
void addPanel(MeshBuilder& builder, const Pose& T_scene_piece, double width, double height,
              double z);
/// Frame of a door's opening, in the wall's frame (see MeshBuilder::wall), and a leaf that stands
/// open by `leaf_deg` (0: no leaf; the sign tells to which side of the wall).
void addDoor(MeshBuilder& builder, const Pose& T_scene_wall, const WallOpening& opening,
             double thickness, double leaf_deg);
/// Frame, cross bar and inner sill of a window's opening; the sill stands out to the wall's +y.
void addWindow(MeshBuilder& builder, const Pose& T_scene_wall, const WallOpening& opening,
               double thickness);
void addRadiator(MeshBuilder& builder, const Pose& T_scene_piece, double width);

}  // namespace paloc::synth
