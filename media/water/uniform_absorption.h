#pragma once

#include <string>
#include <vector>

#include "core/base/spectrum.h"
#include "core/scene/water_desc.h"
#include "media/water/jerlov.h"

namespace uw {

/// Absorption per band of everything in the water except particles [1/m]: as given, or the preset's
/// (nullptr: pure water's) plus cdom and chlorophyll. Adds a line to `warnings` for each part that
/// does not cover the bands. Bands outside pure water's table: InputError.
Spectrum uniform_absorption(const WaterDesc& water, const JerlovPreset* preset,
                            std::vector<std::string>& warnings);

}  // namespace uw
