#include "media/vdb_file.h"

#include <fmt/format.h>

#define NANOVDB_USE_TBB
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "media/vdb_stream.h"

namespace uw {
namespace {

constexpr int k_largest_index = 1 << 30;

/// Makes every value finite and >= 0, zero voxels inactive, inactive ones zero, and prunes.
GridIntake sanitize(openvdb::FloatTree& tree) {
    using Tree = openvdb::FloatTree;
    tree.root().setBackground(0.0F, /*updateChildNodes=*/false);
    GridIntake total;
    auto tiles = tree.beginValueAll();
    tiles.setMaxDepth(Tree::ValueAllIter::LEAF_DEPTH - 1);
    for (; tiles; ++tiles) {
        const auto voxels = static_cast<std::int64_t>(tiles.getVoxelCount());
        const float value = tiles.isValueOn() ? total.take(*tiles, voxels) : 0.0F;
        tiles.setValue(value);
        tiles.setActiveState(value > 0);
    }
    openvdb::tree::LeafManager<Tree> leaves(tree);
    std::vector<GridIntake> parts(leaves.leafCount());  // summed in order: the same for any threads
    leaves.foreach ([&parts](Tree::LeafNodeType& leaf, std::size_t index) {
        float* values = leaf.buffer().data();
        for (openvdb::Index n = 0; n < Tree::LeafNodeType::SIZE; ++n) {
            values[n] = leaf.isValueOn(n) ? parts[index].take(values[n], 1) : 0.0F;
            leaf.setActiveState(n, values[n] > 0);
        }
    });
    for (const GridIntake& part : parts) total.add(part);
    openvdb::tools::prune(tree);  // blocks of one value become tiles, which cost nothing
    return total;
}

void append_brick(const openvdb::FloatGrid& grid, std::vector<NanoGrid>& bricks) {
    openvdb::CoordBBox box;
    if (!grid.tree().evalActiveVoxelBoundingBox(box)) return;
    for (int axis = 0; axis < 3; ++axis)
        if (box.min()[axis] <= -k_largest_index || box.max()[axis] >= k_largest_index)
            throw std::range_error("it has voxels further than 2^30 from its origin");
    nanovdb::OpenToNanoVDB<float, nanovdb::Fp16> converter;
    converter.setStats(nanovdb::StatsMode::Disable);
    converter.setChecksum(nanovdb::ChecksumMode::Disable);
    auto handle = std::make_shared<nanovdb::GridHandle<nanovdb::HostBuffer>>(converter(grid));
    const void* data = handle->data();
    const std::size_t bytes = handle->size();
    bricks.emplace_back(std::move(handle), data, bytes,
                        std::array{box.min().x(), box.min().y(), box.min().z()},
                        std::array{box.max().x(), box.max().y(), box.max().z()});
}

/// The slab's values as a float grid without transform (bricks work in index space).
GridIntake take_slab(const openvdb::FloatGrid::Ptr& grid, std::vector<NanoGrid>& bricks) {
    const GridIntake intake = sanitize(grid->tree());
    grid->setTransform(openvdb::math::Transform::createLinearTransform());
    append_brick(*grid, bricks);
    return intake;
}

GridIntake take_slab(openvdb::DoubleGrid::Ptr grid, std::vector<NanoGrid>& bricks) {
    auto tree = std::make_shared<openvdb::FloatTree>(grid->tree());
    grid.reset();
    return take_slab(openvdb::FloatGrid::create(tree), bricks);
}

template <class GridT>
GridIntake read_grid(const VdbHeader& header, const GridSummary& grid, std::size_t slab_bytes,
                     const SourceLocation& where, LoadedGrid& loaded) {
    GridIntake total;
    read_slabs<GridT>(header, grid, slab_bytes, where, [&](typename GridT::Ptr slab) {
        loaded.file_from_index = to_affine(slab->transform());
        loaded.statistics.background = static_cast<double>(slab->background());
        total.add(take_slab(std::move(slab), loaded.bricks));
    });
    return total;
}

}  // namespace

Affine read_file_from_index(const VdbHeader& header, const std::string& name,
                            const SourceLocation& where) {
    initialize_openvdb();
    const GridSummary& grid = select_grid(header, name, where);
    return read_guarded(describe_grid_place(header, grid, where),
                        [&] { return to_affine(*read_transform(header, grid, where)); });
}

LoadedGrid load_grid(const VdbHeader& header, const std::string& name, const SourceLocation& where,
                     std::size_t slab_bytes) {
    initialize_openvdb();
    const GridSummary& grid = select_grid(header, name, where);
    const std::string prefix = describe_grid_place(header, grid, where);
    LoadedGrid loaded;
    loaded.name = grid.name;
    const GridIntake intake = read_guarded(prefix, [&] {
        return grid.value_type == "double"
                   ? read_grid<openvdb::DoubleGrid>(header, grid, slab_bytes, where, loaded)
                   : read_grid<openvdb::FloatGrid>(header, grid, slab_bytes, where, loaded);
    });
    loaded.statistics = intake.statistics(loaded.statistics.background);
    const bool classless = grid.grid_class != "fog volume";
    if (classless && loaded.statistics.background > 0 && intake.negative > 0)
        throw InputError(fmt::format(
            "{}is a level set, though its class is '{}' (background {:g}, {} negative voxels), not "
            "a concentration; export a fog volume; the file has {}",
            prefix, grid.grid_class, loaded.statistics.background, intake.negative,
            header.describe_grids()));
    const double determinant = loaded.file_from_index.determinant();
    if (!std::isfinite(determinant) || determinant == 0)
        throw InputError(prefix + "its transform is singular (voxels without volume)");
    loaded.warnings = intake_warnings(loaded.statistics, prefix);
    return loaded;
}

}  // namespace uw
