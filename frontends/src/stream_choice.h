#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "paloc/core/time.h"

namespace paloc {

/// Which of a recording's streams of one kind (LiDARs, IMUs, odometries) is used: that with the
/// label asked for, or else the first that comes.
class StreamChoice {
 public:
  /// `kind` as in a sentence: "LiDAR". An empty label asks for the first.
  StreamChoice(std::string kind, std::string label)
      : kind_(std::move(kind)), wanted_(std::move(label)) {}

  /// Whether this is the stream to use; also remembers that it exists.
  bool takes(const std::string& class_name, const std::string& label);

  bool chosen() const { return chosen_.has_value(); }
  bool isChosen(const std::string& class_name, const std::string& label) const {
    return chosen_ == std::pair(class_name, label);
  }
  /// A sentence if there are others, and none was chosen; else empty.
  std::string remark() const;
  /// A sentence if the label asked for is not there; else empty.
  std::string problem() const;

 private:
  std::string listed() const;

  std::string kind_, wanted_;
  std::optional<std::pair<std::string, std::string>> chosen_;
  std::vector<std::pair<std::string, std::string>> seen_;  // class and label, by first appearance
};

/// Guards the order of one stream's stamps.
class StampOrder {
 public:
  /// Empty if the stamp follows the last one, else why it is not taken. A stamp a minute or more
  /// ahead is taken for wrong unless the next one goes on from there: a single wrong stamp must not
  /// make everything after it look old.
  std::string check(TimeNs t_ns);

 private:
  std::optional<TimeNs> last_, ahead_;
};

}  // namespace paloc
