#pragma once

namespace paloc {

/// Scans after a search, for and against what it found.
struct Confirmation {
  int confirmations = 0, objections = 0;

  void count(bool bears_out) { ++(bears_out ? confirmations : objections); }
  /// What was found does not survive two scans against it, unless four times as many bear it out:
  /// now and then a scan is refused at the right place as well, and a platform may rest for long.
  bool refuted() const { return objections >= 2 && confirmations < 4 * objections; }
};

}  // namespace paloc
