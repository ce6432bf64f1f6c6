#include "paloc/core/lost_nodes.h"

namespace paloc {

std::size_t firstLost(const std::vector<HistoryNode>& history,
                      const std::vector<FrameDiagnostics>& diagnostics) {
  std::size_t first = history.size();
  while (first > 0 && !history[first - 1].association.match.accepted()) {
    --first;
    const FrameDiagnostics& row = diagnostics[history[first].diagnostics_index];
    if (!row.has_imu_factor && !row.has_odometry_factor) break;
  }
  return first;
}

void displace(const Pose& T_new_old, State& state) {
  state.T_map_body = T_new_old * state.T_map_body;
  state.v_map = T_new_old.rotation * state.v_map;
}

}  // namespace paloc
