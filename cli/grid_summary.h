#pragma once

#include <string>

#include "core/medium.h"
#include "media/grid_field.h"

namespace uw {

/// What the user is told about one grid in use, as lines of text: metres per voxel, world bounds,
/// concentrations, how it was placed, and the optical depth across it per band.
std::string describe_grid(const VolumeReport& report, const Medium& medium);

}  // namespace uw
