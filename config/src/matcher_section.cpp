#include "section.h"

namespace paloc {
namespace {

using S = MatcherSettings;

template <typename Rows>
void addPointsAndDistances(Rows& s) {
  s.count("max_points", &S::max_points, {100, 1000000},
          "Points of a scan at most, spread evenly over the surfaces, each the mean of the "
          "returns about it.");
  s.number("max_distance_m", &S::max_distance_m, "m", {0.01, 10},
           "Largest distance of a point to its map point in the first two iterations.");
  s.number("fine_distance_m", &S::fine_distance_m, "m", {0.01, 10},
           "The same from the third iteration on.");
  s.number("research_distance_m", &S::research_distance_m, "m", {0, 1},
           "A point that moved less than this keeps its map point.");
}

template <typename Rows>
void addNoise(Rows& s) {
  s.number("range_noise_m", &S::range_noise_m, "m", {1e-4, 1},
           "Standard deviation of a return's range, from the data sheet.");
  s.number("map_noise_m", &S::map_noise_m, "m", {1e-4, 1},
           "Standard deviation of a map point about its surface.");
  s.number("normal_noise_rad", &S::normal_noise_rad, "rad", {0, 1},
           "Standard deviation of a map normal beyond what its fit tells: uneven walls.");
  s.number("plane_bias_m", &S::plane_bias_m, "m", {0, 1},
           "Error that all returns from one plane patch share.");
  s.number("plane_patch_m", &S::plane_patch_m, "m", {0.1, 1000},
           "Radius of such a patch: a wall, as far as it shares an error.");
  s.number("range_bias_m", &S::range_bias_m, "m", {0, 1},
           "Error that all returns of a scan share.");
}

template <typename Rows>
void addGates(Rows& s) {
  s.number("min_overlap", &S::min_overlap, "", {0, 1},
           "Share of a scan's points that must find a plane of the map.");
  s.count("min_inliers", &S::min_inliers, {6, 1000000},
          "Fewer points within the gate and the match is refused.");
  s.number("max_residual_rms_m", &S::max_residual_rms_m, "m", {1e-3, 10},
           "Larger residuals of the inliers and the match is refused.");
  s.number("max_step_sigmas", &S::max_step_sigmas, "", {0.1, 1000},
           "Largest step from the prediction that is believed, in its standard deviations.");
  s.number("step_floor_m", &S::step_floor_m, "m", {0, 100},
           "Added in squares to the prediction's standard deviation of position.");
  s.number("step_floor_rad", &S::step_floor_rad, "rad", {0, 4}, "The same for rotation.");
  s.count("max_iterations", &S::max_iterations, {1, 1000}, "Steps of the registration.");
}

template <typename Rows>
void addLocate(Rows& s) {
  s.number(
      "locate_distance_m", &S::locate_distance_m, "m", {0.01, 100},
      "Largest distance of a point to its map point in the first iterations of a rough start.");
  s.number("locate_max_step_m", &S::locate_max_step_m, "m", {0.01, 100},
           "Furthest that a rough start is corrected by.");
  s.number("locate_max_step_rad", &S::locate_max_step_rad, "rad", {0.01, 4},
           "The same for rotation.");
  s.number("locate_min_inlier_share", &S::locate_min_inlier_share, "", {0, 1},
           "Share of the matched points within 10 cm of their plane, below which a start is not "
           "believed.");
}

template <typename Rows>
void addStart(Rows& s) {
  s.number("start_reach_m", &S::start_reach_m, "m", {0.1, 100},
           "A start is searched within this of a rough position, along each axis.");
  s.number("start_reach_rad", &S::start_reach_rad, "rad", {0.01, 3.15},
           "And within this of a rough pose's heading.");
  s.number("start_position_reach_m", &S::start_position_reach_m, "m", {0.1, 100},
           "As start_reach_m, where a position is known and no heading.");
  s.number("start_cell_m", &S::start_cell_m, "m", {0.05, 5},
           "Cell of the search's grid; it grows where the map is too large for it.");
  s.number("start_min_explained", &S::start_min_explained, "", {0, 1},
           "Share of a scan's points on surfaces of the map, below which a start is not believed.");
  s.number(
      "start_max_contradicted", &S::start_max_contradicted, "", {0, 1},
      "Share of a scan's points in space that the map shows open, from which on a start is not "
      "believed: another place or storey. More where much has changed since the survey.");
  s.number(
      "start_min_lead", &S::start_min_lead, "", {0, 1},
      "Lead in what speaks for it over the second-best place, below which a start is ambiguous.");
  s.number("start_max_mlookups", &S::start_max_mlookups, "", {1, 1e6},
           "Million look-ups in the grids after which a search is given up.");
}

template <typename Rows>
void addDegeneracy(Rows& s) {
  s.flag("degeneracy_handling", &S::degeneracy_handling,
         "Scale the information of weak directions down, hold and leave out open ones; false "
         "takes all that the equations claim, to see what happens.");
  s.flag("spectrum", &S::spectrum,
         "Compare the scan's own surfaces with the map's: D_e in diagnostics.csv, a figure only.");
}

}  // namespace

std::vector<Setting> matcherSettings() {
  Section s(
      "matcher", [](auto& config) -> auto& { return config.matcher; });
  addPointsAndDistances(s);
  addNoise(s);
  addGates(s);
  addLocate(s);
  addStart(s);
  addDegeneracy(s);
  s.count("threads", &S::threads, {1, 64},
          "Threads that seek correspondences; no influence on the result.");
  return std::move(s).rows();
}

}  // namespace paloc
