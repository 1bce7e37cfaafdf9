#pragma once

#include <openvdb/openvdb.h>

/// OpenVDB grids, created without instantiating templates that OpenVDB itself contains.
///
/// A tree's virtual functions alone, which a compiler instantiates wherever a tree is constructed,
/// take ten seconds to compile for each value type. OpenVDB contains them all: grids are therefore
/// created by its registry (make_empty_grid), read through GridBase, and cast to their type only
/// where values are accessed.
namespace uw {

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

}  // namespace uw
