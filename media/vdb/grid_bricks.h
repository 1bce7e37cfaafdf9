#pragma once

#include <openvdb/openvdb.h>

#include <vector>

#include "media/vdb/grid_statistics.h"
#include "media/vdb/nano_grid.h"

/// Conversion from OpenVDB's grids to those that are rendered, for the files that read volumes.
namespace uw {

/// Makes every value finite and >= 0, zero voxels inactive and inactive voxels zero, and prunes the
/// tree.
GridIntake sanitize(openvdb::FloatTree& tree);

/// Appends the slab's values (sanitized, if any are left), without its transform: bricks work in
/// index space. Throws std::range_error for voxels too far away.
GridIntake take_slab(const openvdb::FloatGrid::Ptr& grid, std::vector<NanoGrid>& bricks);

/// A float grid itself, or a double grid converted to floats.
openvdb::FloatGrid::Ptr to_float(const openvdb::GridBase::Ptr& grid);

/// The background value of a float or double grid.
double background_of(const openvdb::GridBase& grid);

}  // namespace uw
