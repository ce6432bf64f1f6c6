#include "stream_choice.h"

#include <algorithm>

namespace paloc {

bool StreamChoice::takes(const std::string& class_name, const std::string& label) {
  const std::pair<std::string, std::string> stream(class_name, label);
  if (std::find(seen_.begin(), seen_.end(), stream) == seen_.end()) seen_.push_back(stream);
  if (!chosen_ && (wanted_.empty() || label == wanted_)) chosen_ = stream;
  return chosen_ == stream;
}

std::string StreamChoice::listed() const {
  std::string there;
  for (const auto& [class_name, label] : seen_) {
    there += (there.empty() ? "'" : ", '") + label + "' (" + class_name + ")";
  }
  return there;
}

std::string StreamChoice::remark() const {
  if (!wanted_.empty() || seen_.size() < 2) return {};
  return "there are several " + kind_ +
         " streams, of which the first is used, as none was chosen: " + listed();
}

std::string StreamChoice::problem() const {
  if (wanted_.empty() || chosen_) return {};
  return "there is no " + kind_ + " with the label '" + wanted_ + "'; " +
         (seen_.empty() ? "there is none at all" : "there are: " + listed());
}

std::string StampOrder::check(TimeNs t_ns) {
  constexpr TimeNs kFarAhead = 60 * kNsPerSecond;
  if (last_ && t_ns == *last_) return "repeated stamp";
  if (last_ && t_ns < *last_) return "time goes backwards";
  if (last_ && t_ns - *last_ >= kFarAhead) {
    const bool goes_on = ahead_ && t_ns > *ahead_ && t_ns - *ahead_ < kFarAhead;
    if (!goes_on) {
      ahead_ = t_ns;
      return "stamp a minute or more ahead";
    }
  }
  ahead_.reset();
  last_ = t_ns;
  return {};
}

}  // namespace paloc
