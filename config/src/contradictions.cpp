#include "value.h"

namespace paloc {

Contradiction findContradiction(const Config& config) {
  const FrontendSettings& frontend = config.frontend;
  if (frontend.min_range_m >= frontend.max_range_m) {
    return {"frontend.min_range_m", formatValue(frontend.min_range_m) +
                                        " is not below frontend.max_range_m, " +
                                        formatValue(frontend.max_range_m)};
  }
  return {};
}

}  // namespace paloc
