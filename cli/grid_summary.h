#pragma once

#include <string>
#include <vector>

#include "cli/report.h"
#include "core/light/medium.h"
#include "media/volumes/load_volumes.h"

namespace uw {

/// The summary for the user of one grid in use: metres per voxel, world bounds, concentrations,
/// placement, and the optical depth across it per band.
Report report_on_grid(const VolumeReport& volume, const Medium& medium);
std::string describe_grid(const VolumeReport& volume, const Medium& medium);  // as text

/// Optical depth of the grid's own particles along world axis `axis` (0, 1, 2) through the centre
/// of its bounds, per band.
std::vector<double> depth_through_middle(const VolumeReport& report, const Medium& medium,
                                         std::size_t axis);

/// "x -1..1, y 0..3, z 2..5 m".
std::string bounds_text(const Bounds& bounds);

}  // namespace uw
