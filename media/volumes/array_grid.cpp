#include "media/volumes/array_grid.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "media/volumes/grid_bricks.h"
#include "media/volumes/vdb_file.h"
#include "media/volumes/vdb_header.h"
#include "media/volumes/vdb_stream.h"

namespace uw {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr std::size_t k_edge = k_leaf_edge;
constexpr std::size_t k_longest_side = std::size_t{1} << 30;

std::size_t blocks_along(std::size_t size) {
    return (size + k_edge - 1) / k_edge;
}

/// The block of 8^3 values from (i, j, k) on; nothing if all are 0.
std::unique_ptr<Leaf> block_of(const ArrayView& values, std::size_t i, std::size_t j,
                               std::size_t k) {
    const auto end = [&](std::size_t begin, std::size_t axis) {
        return std::min(begin + k_edge, values.size[axis]);
    };
    std::unique_ptr<Leaf> leaf;
    for (std::size_t x = i; x < end(i, 0); ++x)
        for (std::size_t y = j; y < end(j, 1); ++y)
            for (std::size_t z = k; z < end(k, 2); ++z) {
                const float value = values.at(x, y, z);
                if (value == 0) continue;
                if (!leaf)
                    leaf = std::make_unique<Leaf>(
                        openvdb::Coord(static_cast<int>(i), static_cast<int>(j),
                                       static_cast<int>(k)),
                        0.0F);
                const auto n =
                    static_cast<openvdb::Index>(((x - i) << 6U) | ((y - j) << 3U) | (z - k));
                leaf->setValueOn(n, value);
            }
    return leaf;
}

/// The values with first indices [begin, end), whole blocks, as a grid of OpenVDB.
openvdb::FloatGrid::Ptr slab_of(const ArrayView& values, std::size_t begin, std::size_t end) {
    auto grid = make_empty_grid<openvdb::FloatGrid>(0.0F);
    const std::size_t rows = blocks_along(values.size[1]), columns = blocks_along(values.size[2]);
    std::vector<std::unique_ptr<Leaf>> blocks(blocks_along(end - begin) * rows * columns);
    parallel_for(blocks.size() / columns, [&](std::size_t line) {
        const std::size_t i = begin + line / rows * k_edge, j = line % rows * k_edge;
        for (std::size_t column = 0; column < columns; ++column)
            blocks[line * columns + column] = block_of(values, i, j, column * k_edge);
    });
    for (std::unique_ptr<Leaf>& block : blocks)
        if (block) grid->tree().addLeaf(block.release());  // the tree owns it
    return grid;
}

/// Copies what `grid` has of the array's box into it.
void copy_values(const openvdb::FloatGrid& grid, GridArray& array) {
    const auto offset = [&](const openvdb::Coord& at) {
        std::size_t index = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            index =
                index * array.size[axis] + static_cast<std::size_t>(at[axis] - array.first[axis]);
        return index;
    };
    for (auto value = grid.tree().cbeginValueOn(); value; ++value) {
        if (value.isVoxelValue()) {
            array.values[offset(value.getCoord())] = *value;
            continue;
        }
        const openvdb::CoordBBox box = value.getBoundingBox();
        for (int i = box.min().x(); i <= box.max().x(); ++i)
            for (int j = box.min().y(); j <= box.max().y(); ++j)
                std::fill_n(&array.values[offset({i, j, box.min().z()})],
                            static_cast<std::size_t>(box.dim().z()), *value);
    }
}

}  // namespace

LoadedGrid grid_of_array(const ArrayView& values, const Affine& place, std::string name,
                         const SourceLocation& where) {
    initialize_openvdb();
    const std::string prefix = where + ": ";
    LoadedGrid grid;
    grid.name = std::move(name);
    grid.file_from_index = place;
    grid.size = values.size;
    for (const std::size_t side : values.size)
        if (side > k_longest_side)
            throw InputError(
                fmt::format("{}{} values along a side, more than 2^30; use fewer", prefix, side));
    check_loaded({}, {}, prefix, grid);
    const std::size_t layer = values.size[1] * values.size[2] * sizeof(float) * k_edge;
    const std::size_t slab =
        std::max(k_edge, k_default_slab_bytes / std::max<std::size_t>(layer, 1) * k_edge);
    GridIntake intake;
    read_guarded(prefix, [&] {
        for (std::size_t begin = 0; begin < values.size[0]; begin += slab)
            intake.add(take_slab(slab_of(values, begin, std::min(begin + slab, values.size[0])),
                                 grid.bricks));
    });
    grid.statistics = intake.statistics(0);
    grid.warnings = intake_warnings(grid.statistics, prefix);
    return grid;
}

GridArray read_grid_array(const VdbHeader& header, const std::string& name,
                          const SourceLocation& where) {
    initialize_openvdb();
    const GridSummary& grid = select_grid(header, name, where);
    const std::string prefix = describe_grid_place(header, grid, where);
    GridArray array;
    array.name = grid.name;
    std::vector<openvdb::FloatGrid::Ptr> slabs;
    openvdb::CoordBBox box;
    read_guarded(prefix, [&] {
        read_slabs(header, grid, k_default_slab_bytes, where,
                   [&](const openvdb::GridBase::Ptr& slab) {
                       array.file_from_index = to_affine(slab->transform());
                       slabs.push_back(to_float(slab));
                       openvdb::CoordBBox part;
                       if (slabs.back()->baseTree().evalActiveVoxelBoundingBox(part))
                           box.expand(part);
                   });
    });
    if (box.empty()) return array;
    double bytes = sizeof(float);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        array.first[axis] = box.min()[axis];
        array.size[axis] = static_cast<std::size_t>(box.dim()[axis]);
        bytes *= static_cast<double>(array.size[axis]);
    }
    require_memory(bytes,
                   fmt::format("{}all values of its box of {} x {} x {} voxels take", prefix,
                               array.size[0], array.size[1], array.size[2]),
                   "use the file itself");
    array.values.resize(array.size[0] * array.size[1] * array.size[2]);
    for (const openvdb::FloatGrid::Ptr& slab : slabs) copy_values(*slab, array);
    return array;
}

}  // namespace uw
