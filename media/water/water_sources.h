#pragma once

#include <string>
#include <vector>

#include "core/scene/volume_desc.h"
#include "core/scene/water_desc.h"

namespace uw {

/// Where the numbers of a water come from, one line each: "absorption: ...", "scattering: ...",
/// and one line per grid that adds to it. `small_ppm` and `large_ppm` are the background
/// particles that build_water_model settled on.
std::vector<std::string> water_sources(const WaterDesc& water,
                                       const std::vector<VolumeDesc>& volumes, double small_ppm,
                                       double large_ppm);

}  // namespace uw
