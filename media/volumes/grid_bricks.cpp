#include "media/volumes/grid_bricks.h"

#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tree/LeafManager.h>

#include <array>
#include <memory>
#include <stdexcept>
#include <utility>

namespace uw {

void initialize_openvdb() {
    static const bool done = (openvdb::initialize(), true);
    static_cast<void>(done);
}

namespace {

constexpr int k_max_index = 1 << 30;

void append_brick(const openvdb::FloatGrid& grid, std::vector<NanoGrid>& bricks) {
    openvdb::CoordBBox box;
    if (!grid.baseTree().evalActiveVoxelBoundingBox(box)) return;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (box.min()[axis] <= -k_max_index || box.max()[axis] >= k_max_index)
            throw std::range_error("it has voxels more than 2^30 from its origin");
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

}  // namespace

namespace {

/// Sanitises the tiles of a node and of those below it.
template <class Node>
void sanitize_tiles(Node& node, GridIntake& total) {
    for (auto tile = node.beginValueAll(); tile; ++tile) {
        constexpr auto k_voxels = static_cast<std::int64_t>(Node::ChildNodeType::NUM_VOXELS);
        const float value = tile.isValueOn() ? total.take(*tile, k_voxels) : 0.0F;
        tile.setValue(value);
        tile.setValueOn(value > 0);
    }
    if constexpr (Node::LEVEL > 1)
        for (auto child = node.beginChildOn(); child; ++child) sanitize_tiles(*child, total);
}

}  // namespace

GridIntake sanitize(openvdb::FloatTree& tree) {
    using Tree = openvdb::FloatTree;
    tree.root().setBackground(0.0F, /*updateChildNodes=*/false);
    GridIntake total;
    sanitize_tiles(tree.root(), total);
    openvdb::tree::LeafManager<Tree> leaves(tree);
    std::vector<GridIntake> parts(
        leaves.leafCount());  // summed in order, so independent of threads
    leaves.foreach ([&parts](Tree::LeafNodeType& leaf, std::size_t index) {
        float* values = leaf.buffer().data();
        for (openvdb::Index n = 0; n < Tree::LeafNodeType::SIZE; ++n) {
            values[n] = leaf.isValueOn(n) ? parts[index].take(values[n], 1) : 0.0F;
            leaf.setActiveState(n, values[n] > 0);
        }
    });
    for (const GridIntake& part : parts) total.add(part);
    openvdb::tools::prune(tree);  // constant blocks become tiles, which cost nothing
    return total;
}

GridIntake take_slab(const openvdb::FloatGrid::Ptr& grid, std::vector<NanoGrid>& bricks) {
    const GridIntake intake = sanitize(grid->tree());
    grid->setTransform(openvdb::math::Transform::createLinearTransform());
    append_brick(*grid, bricks);
    return intake;
}

openvdb::FloatGrid::Ptr to_float(const openvdb::GridBase::Ptr& grid) {
    const auto doubles = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid);
    if (!doubles) return openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
    auto floats = make_empty_grid<openvdb::FloatGrid>(0.0F);
    floats->tree().root() = doubles->tree().root();
    floats->setTransform(doubles->transformPtr());
    return floats;
}

double background_of(const openvdb::GridBase& grid) {
    double background = 0;
    grid.apply<openvdb::RealGridTypes>(
        [&](const auto& typed) { background = static_cast<double>(typed.background()); });
    return background;
}

}  // namespace uw
