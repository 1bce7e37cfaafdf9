#pragma once

#include <optional>
#include <string>

#include "core/optics/medium.h"
#include "media/volumes/load_volumes.h"

namespace uw {

/// The optical depth of the longest edge of a grid's voxels where it is densest, in the band that
/// it attenuates most.
double voxel_depth(const VolumeReport& report, const Medium& medium);

/// One line about a grid of voxels so dense that lamps' light changes within them more than what is
/// interpolated between rays half a voxel apart; none for others. Beyond 4 optical depths light is
/// 2 % off where it enters such a cloud, beyond 15 5 %, beyond 40 8 %.
std::optional<std::string> coarse_voxel_warning(const VolumeReport& report, const Medium& medium);

}  // namespace uw
