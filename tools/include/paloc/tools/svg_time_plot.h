#pragma once

#include <string>
#include <vector>

#include "paloc/tools/svg_axes.h"

namespace paloc {

/// A quantity over time. A value that is not finite breaks the line.
struct PlotLine {
  std::string css;    ///< "s1" to "s4" (the palette's colours), "total", "refused"
  std::string label;  ///< in the legend; empty: not in it
  std::vector<double> t_s;
  std::vector<double> values;  ///< as many as `t_s`, in the plot's unit
  bool dots = false;           ///< single marks instead of a line
};

/// A stretch of time that is shaded.
struct PlotBand {
  std::string css;  ///< "band-coasting"
  double begin_s = 0;
  double end_s = 0;
  std::string label;  ///< shown when pointed at; may be empty
};

/// Lines over a common time axis.
struct TimePlot {
  std::string title;    ///< "Residual of the inliers (rms)"
  std::string unit;     ///< of the values ("cm")
  std::string summary;  ///< what a reader who does not see it is told; also in the caption
  PlotRange time_s;
  std::vector<PlotLine> lines;
  std::vector<PlotBand> bands;
  bool logarithmic = false;
  double reaches = 0;     ///< a linear axis goes at least this far up
  bool from_zero = true;  ///< the axis of a linear plot begins at zero
};

/// The figure: caption with legend, and the plot for wide and for narrow windows.
std::string timePlotFigure(const TimePlot& plot);

/// A bar over time in the colours of the bands, without a value axis; same time axis as the plots'.
std::string timeBandFigure(const TimePlot& plot);

}  // namespace paloc
