#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cli/pages/svg_plot.h"
#include "cli/report.h"
#include "core/scene/volume_desc.h"
#include "core/scene/water_desc.h"
#include "media/inspection/water_table.h"

namespace uw {

/// What `uwvdb water` reports on, and how.
struct WaterSurvey {
    std::string title;  // "jerlov-II", "plume.yaml", "pure sea water"
    WaterDesc water;
    std::vector<VolumeDesc> volumes;
    WaterTable table;
    std::vector<std::string> sources;    // one line each
    std::vector<std::size_t> vsf_bands;  // wavelengths whose VSF is reported
    std::size_t plot_band = 0;           // the one whose VSF is plotted
};

/// Scattering angles of the printed VSF table [deg].
const std::vector<double>& printed_angles();
/// Scattering angles of the VSF in files [deg]: 0, steps of 0.01 to 0.1, of 0.1 to 1, of 1 to 180.
const std::vector<double>& file_angles();

/// The tables with units and sources. Undefined ratios (0/0) are dashes in text and null in JSON.
Report report_on_water(const WaterSurvey& survey);

/// CSV (RFC 4180, preceded by one comment line with units and sources): one row per wavelength.
/// Undefined ratios (0/0) are blank.
std::string water_coefficients_csv(const WaterSurvey& survey);
/// CSV: one row per wavelength and angle, total first, then each component, then per unit of each
/// constituent.
std::string water_vsf_csv(const WaterSurvey& survey);

/// Coefficients over wavelength, scattering by component, and the VSF of the plotted band with its
/// components over angle on a linear and a logarithmic axis (figure 4 of Sedlazeck and Koch 2011);
/// if grids add constituents, the same per unit of these. Fine curves where models provide them,
/// dots at the wavelengths of the table.
PlotFigure water_figure(const WaterSurvey& survey);

}  // namespace uw
