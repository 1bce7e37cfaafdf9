#pragma once

#include <openvdb/openvdb.h>

/// Grids of OpenVDB's, made without instantiating what OpenVDB itself holds.
///
/// A tree's virtual functions alone, which a compiler instantiates wherever a tree is constructed,
/// take it ten seconds for each value type. OpenVDB holds them all: grids are therefore made by its
/// registry (make_empty_grid), read through GridBase, and seen as typed only by what looks at
/// values.
namespace uw {

/// To be called before anything is read or made.
void initialize_openvdb();

/// The grids whose values are read.
using ReadableGrids = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                                        openvdb::Int64Grid, openvdb::Vec3SGrid, openvdb::Vec3DGrid,
                                        openvdb::Vec3IGrid>;

/// An empty grid, as GridT::create(background) makes it.
template <class GridT>
typename GridT::Ptr make_empty_grid(const typename GridT::ValueType& background) {
    auto grid = openvdb::gridPtrCast<GridT>(openvdb::GridBase::createGrid(GridT::gridType()));
    grid->tree().root().setBackground(background, /*updateChildNodes=*/false);
    return grid;
}

}  // namespace uw
