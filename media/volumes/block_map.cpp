#include "media/volumes/block_map.h"

#include <algorithm>
#include <cmath>

namespace uw {
namespace {

using nanovdb::Coord;

/// Calls `visit(low, edge)` for each of a node's tiles whose value is not zero.
template <typename Node, typename Visit>
void for_each_tile(const Node& node, const Visit& visit) {
    constexpr int k_edge = static_cast<int>(Node::ChildNodeType::DIM);
    const auto& data = *node.data();
    for (std::uint32_t n = 0; n < Node::SIZE; ++n)
        if (!data.mChildMask.isOn(n) && data.mTable[n].value != 0)
            visit(node.offsetToGlobalCoord(n), k_edge);
}

}  // namespace

std::shared_ptr<const BlockMap> BlockMap::of(const Grid& grid, const Bounds& support) {
    constexpr double k_few = 1 << 16;
    const Vector3 blocks = (support.max - support.min) / double{k_edge} + 2.0;
    const double count = blocks.x * blocks.y * blocks.z;
    if (!(count <= std::max(k_few, static_cast<double>(grid.gridSize())))) return nullptr;
    return std::shared_ptr<const BlockMap>(new BlockMap(grid, support));
}

BlockMap::BlockMap(const Grid& grid, const Bounds& support) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<int>(axis);
        first_[axis] = static_cast<int>(support.min[at]) >> k_edge_bits;
        const int last = static_cast<int>(support.max[at]) >> k_edge_bits;
        size_[axis] = static_cast<unsigned>(last - first_[axis] + 1);
    }
    codes_.assign(index(size_[0], 0, 0), 0);
    const auto& tree = grid.tree();
    const auto mark_tile = [&](const Coord& low, int edge) { mark(Kind::tile, low, edge); };
    const auto& root = *tree.root().data();
    for (std::uint32_t n = 0; n < root.mTableSize; ++n)
        if (const auto& tile = *root.tile(n); !tile.isChild() && tile.value != 0)
            mark_tile(tile.origin(), static_cast<int>(nanovdb::NanoUpper<nanovdb::Fp16>::DIM));
    for (std::uint32_t n = 0; n < tree.nodeCount(2); ++n)
        for_each_tile(tree.getFirstNode<2>()[n], mark_tile);
    for (std::uint32_t n = 0; n < tree.nodeCount(1); ++n)
        for_each_tile(tree.getFirstNode<1>()[n], mark_tile);
    for (std::uint32_t n = 0; n < tree.nodeCount(0); ++n)
        mark(Kind::voxels, tree.getFirstNode<0>()[n].origin(), k_edge);
    find_edges();
    find_distances();
}

void BlockMap::mark(Kind kind, const Coord& low, int edge) {
    std::array<std::size_t, 3> begin{}, end{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t at = (low[static_cast<int>(axis)] >> k_edge_bits) - first_[axis];
        const std::int64_t size = size_[axis];
        begin[axis] = static_cast<std::size_t>(std::clamp<std::int64_t>(at, 0, size));
        end[axis] =
            static_cast<std::size_t>(std::clamp<std::int64_t>(at + (edge >> k_edge_bits), 0, size));
    }
    const auto code = static_cast<std::uint8_t>(k_first_kind + static_cast<int>(kind));
    for (std::size_t x = begin[0]; x < end[0]; ++x)
        for (std::size_t y = begin[1]; y < end[1]; ++y)
            for (std::size_t z = begin[2]; z < end[2]; ++z) codes_[index(x, y, z)] = code;
}

void BlockMap::find_edges() {
    constexpr auto k_edge_code = static_cast<std::uint8_t>(k_first_kind + int(Kind::edge));
    // Each block once all those that follow it are still as they were.
    for (std::size_t x = 0; x < size_[0]; ++x)
        for (std::size_t y = 0; y < size_[1]; ++y)
            for (std::size_t z = 0; z < size_[2]; ++z) {
                std::uint8_t& code = codes_[index(x, y, z)];
                for (unsigned side = 1; side < 8 && code == 0; ++side) {
                    const std::size_t i = x + (side >> 2), j = y + (side >> 1 & 1U),
                                      k = z + (side & 1U);
                    if (i < size_[0] && j < size_[1] && k < size_[2] && codes_[index(i, j, k)] != 0)
                        code = k_edge_code;
                }
            }
}

// The chessboard distance to the nearest block that is not empty, by a sweep from either end
// (Rosenfeld and Pfaltz 1966). Outside the box all is empty.
void BlockMap::find_distances() {
    constexpr std::uint8_t k_most = k_first_kind - 1;
    const auto sweep = [&](std::size_t n, bool forward) {
        const std::size_t nz = size_[2], ny = size_[1];
        const std::size_t z = n % nz, y = n / nz % ny, x = n / nz / ny;
        std::uint8_t& code = codes_[n];
        if (code >= k_first_kind) return;
        int least = forward ? k_most : code;
        for (int i = -1; i <= 1; ++i)
            for (int j = -1; j <= 1; ++j)
                for (int k = -1; k <= 1; ++k) {
                    const bool is_before = 9 * i + 3 * j + k < 0;
                    const std::size_t u = x + static_cast<std::size_t>(i),
                                      v = y + static_cast<std::size_t>(j),
                                      w = z + static_cast<std::size_t>(k);
                    if ((i == 0 && j == 0 && k == 0) || is_before != forward || u >= size_[0] ||
                        v >= ny || w >= nz)
                        continue;
                    const std::uint8_t beside = codes_[index(u, v, w)];
                    least = std::min(least, beside >= k_first_kind ? 0 : beside + 1);
                }
        code = static_cast<std::uint8_t>(least);
    };
    for (std::size_t n = 0; n < codes_.size(); ++n) sweep(n, true);
    for (std::size_t n = codes_.size(); n-- > 0;) sweep(n, false);
}

}  // namespace uw
