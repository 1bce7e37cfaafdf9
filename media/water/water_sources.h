#pragma once

#include <string>
#include <vector>

#include "core/scene/volume_desc.h"
#include "core/scene/water_desc.h"

namespace uw {

/// The sources of the water's coefficients, one line each: "absorption: ...", "scattering: ...",
/// and one line per grid that adds to them. `small_ppm` and `large_ppm` are the background
/// particles determined by build_water_model.
std::vector<std::string> water_sources(const WaterDesc& water,
                                       const std::vector<VolumeDesc>& volumes, double small_ppm,
                                       double large_ppm);

}  // namespace uw
