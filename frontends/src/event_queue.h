#pragma once

#include <deque>
#include <optional>
#include <utility>

#include "paloc/core/odometry_frame.h"

namespace paloc {

/// Takes the oldest event, if there is one.
inline std::optional<FrontendEvent> takeFront(std::deque<FrontendEvent>& events) {
  if (events.empty()) return std::nullopt;
  // Not a plain move of the variant: GCC 12 at -O3 then warns of an uninitialized member.
  auto event = std::visit([](auto& e) { return std::optional<FrontendEvent>(std::move(e)); },
                          events.front());
  events.pop_front();
  return event;
}

}  // namespace paloc
