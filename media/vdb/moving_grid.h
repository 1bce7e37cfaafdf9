#pragma once

#include <string>

#include "core/scene/source_location.h"
#include "core/scene/volume_desc.h"
#include "media/vdb/loaded_grid.h"

namespace uw {

/// Reads one grid as load_grid does, averaged over the time that the shutter is open: every voxel's
/// value is the mean of those that the velocity brings there from -shutter/2 to +shutter/2
/// ("Eulerian Motion Blur", Kim and Ko 2007: back along the velocity of the frame's moment, taken
/// half-way). The grid grows by where that reaches. `centering`: of both grids. All of them are in
/// memory at once, with 32 bits. Throws as load_grid, also if a velocity grid is missing or none,
/// or if it moves the grid by more than 128 voxels.
LoadedGrid load_moving_grid(const VdbHeader& header, const std::string& name,
                            const SourceLocation& where, const MotionDesc& motion,
                            Centering centering);

}  // namespace uw
