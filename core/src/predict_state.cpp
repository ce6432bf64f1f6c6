#include "paloc/core/predict_state.h"

namespace paloc {

State predictWithoutImu(const State& last, const OdometryFrame& frame, const Pose& motion,
                        double dt_s) {
  State predicted = last;
  if (frame.continues) {
    predicted.T_map_body = last.T_map_body * motion;
    predicted.v_map = (predicted.T_map_body.position - last.T_map_body.position) / dt_s;
  } else {
    predicted.T_map_body.position += last.v_map * dt_s;
  }
  return predicted;
}

}  // namespace paloc
