#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/scene/volume_desc.h"
#include "core/scene/water_desc.h"
#include "media/water/water_table.h"

namespace uw {

/// What `uwvdb water` reports on, and how.
struct WaterReport {
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

}  // namespace uw
