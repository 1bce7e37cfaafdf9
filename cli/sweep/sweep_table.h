#pragma once

#include <string>

#include "cli/plot/svg_plot.h"
#include "cli/sweep/sweep_run.h"

namespace uw {

/// A row for each picture and part of it: the values that were varied, then what was measured.
std::string sweep_csv(const Sweep& sweep);

/// Contrast, signal to backscatter and evenness over the first axis; a curve for each part, or for
/// each value of a second axis.
PlotFigure sweep_figure(const Sweep& sweep, const SweepArguments& arguments);

/// Where the contrast is best, one line without a line break: of the target, else of the last part.
std::string best_of(const Sweep& sweep);

}  // namespace uw
