#pragma once

#include <string>
#include <vector>

#include "core/light/medium.h"
#include "media/volumes/load_volumes.h"

namespace uw {

/// What the user is told about one grid in use, as lines of text: metres per voxel, world bounds,
/// concentrations, placement, and the optical depth across it per band.
std::string describe_grid(const VolumeReport& report, const Medium& medium);

/// Optical depth of the grid's own particles along world axis `axis` (0, 1, 2) through the centre
/// of its bounds, per band.
std::vector<double> depth_through_middle(const VolumeReport& report, const Medium& medium,
                                         std::size_t axis);

}  // namespace uw
