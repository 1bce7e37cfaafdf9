#pragma once

#include "cli/plot/svg_plot.h"
#include "cli/water/water_report.h"

namespace uw {

/// Coefficients over wavelength, scattering by component, and the VSF of the plotted band with its
/// components over angle on a linear and a logarithmic axis (figure 4 of Sedlazeck and Koch 2011);
/// if grids add constituents, the same per unit of these. Fine curves where models provide them,
/// dots at the wavelengths of the table.
PlotFigure water_figure(const WaterReport& report);

}  // namespace uw
