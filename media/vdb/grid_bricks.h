#pragma once

#include <openvdb/openvdb.h>

#include <string>
#include <vector>

#include "media/vdb/vdb_file.h"

/// From OpenVDB's grids to those that are rendered, for the files that read volumes.
namespace uw {

/// Makes every value finite and >= 0, zero voxels inactive, inactive ones zero, and prunes.
GridIntake sanitize(openvdb::FloatTree& tree);

/// Appends the slab's values (sanitized, if any are left), without its transform: bricks work in
/// index space. Throws std::range_error for voxels too far away.
GridIntake take_slab(const openvdb::FloatGrid::Ptr& grid, std::vector<NanoGrid>& bricks);

/// The same grid in floats.
inline openvdb::FloatGrid::Ptr to_float(openvdb::FloatGrid::Ptr grid) {
    return grid;
}
openvdb::FloatGrid::Ptr to_float(const openvdb::DoubleGrid::Ptr& grid);

/// Throws InputError starting with `prefix` if what was loaded is a level set in disguise, or if
/// its voxels have no volume.
void check_loaded(const VdbHeader& header, const GridSummary& grid, const std::string& prefix,
                  const LoadedGrid& loaded);

}  // namespace uw
