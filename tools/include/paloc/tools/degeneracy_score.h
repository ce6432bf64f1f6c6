#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "paloc/core/map_matcher.h"
#include "paloc/tools/degeneracy_labels.h"

namespace paloc {

/// How the classes that a matcher gives compare with the labels of the exact geometry. Strict: only
/// "none" finds a degenerate direction, and "partial" for a full one is as false an alarm as
/// "none".
struct DegeneracyScore {
  std::size_t poses = 0;
  std::size_t refused = 0;         ///< poses without a match, and so without classes: left out
  std::size_t degenerate = 0;      ///< directions that are, of the poses matched
  std::size_t found = 0;           ///< of these, classed none, with the axis within 20 degrees
  std::size_t called_partial = 0;  ///< of these, classed partial
  std::size_t full = 0;            ///< directions that are
  std::size_t false_alarms = 0;    ///< directions classed partial or none that are full
  std::size_t weak = 0;            ///< directions that are neither, and do not count
  std::size_t weak_called_full = 0;
  std::vector<double> axis_errors_deg;  ///< of the directions found

  void add(const LabelledDirections& labels, const std::array<MatchDirection, 6>& directions);
  void merge(const DegeneracyScore& other);

  /// 1 where there is nothing to be found, and nothing was.
  double precision() const;
  double recall() const;
  double f1() const;
  double falseAlarmRate() const;
};

}  // namespace paloc
