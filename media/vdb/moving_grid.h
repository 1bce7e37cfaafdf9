#pragma once

#include <string>

#include "core/scene/source_location.h"
#include "core/scene/volume_desc.h"
#include "media/vdb/loaded_grid.h"

namespace uw {

/// Reads one grid as load_grid does, averaged over the exposure time: every voxel's value is the
/// mean of those advected there from -shutter/2 to +shutter/2 ("Eulerian Motion Blur", Kim and Ko
/// 2007: traced back along the velocity at the frame's time, evaluated at the midpoint). The grid
/// is enlarged accordingly. `centering`: of both grids. All of them are in memory at once, with 32
/// bits. Throws as load_grid, and also if a velocity grid is missing or unusable, or if it moves
/// the grid by more than 128 voxels.
LoadedGrid load_moving_grid(const VdbHeader& header, const std::string& name,
                            const SourceLocation& where, const MotionDesc& motion,
                            Centering centering);

}  // namespace uw
