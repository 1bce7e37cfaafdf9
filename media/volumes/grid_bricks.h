#pragma once

#include <openvdb/openvdb.h>

#include <vector>

#include "media/volumes/loaded_grid.h"

namespace uw {

/// OpenVDB grids, created without instantiating templates that OpenVDB itself contains.
///
/// A tree's virtual functions alone, which a compiler instantiates wherever a tree is constructed,
/// take ten seconds to compile for each value type. OpenVDB contains them all: grids are therefore
/// created by its registry (make_empty_grid), read through GridBase, and cast to their type only
/// where values are accessed.

/// To be called before anything is read or created.
void initialize_openvdb();

/// The grids whose values are read.
using ReadableGrids = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                                        openvdb::Int64Grid, openvdb::Vec3SGrid, openvdb::Vec3DGrid,
                                        openvdb::Vec3IGrid>;

/// An empty grid, as created by GridT::create(background).
template <class GridT>
typename GridT::Ptr make_empty_grid(const typename GridT::ValueType& background) {
    auto grid = openvdb::gridPtrCast<GridT>(openvdb::GridBase::createGrid(GridT::gridType()));
    grid->tree().root().setBackground(background, /*updateChildNodes=*/false);
    return grid;
}

/// Conversion from OpenVDB's grids to those that are rendered, for the files that read volumes.

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
