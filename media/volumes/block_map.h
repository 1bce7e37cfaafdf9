#pragma once

#include <nanovdb/NanoVDB.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/ray.h"

namespace uw {

/// What each block of 8^3 cells of a grid is, in an array over the grid's box, so that a line leaps
/// over empty space instead of asking the tree at every block. Where space is empty for several
/// blocks around, it leaps over all of them (Cohen and Sheffer 1994, proximity clouds). A cell
/// belongs to the block that its lowest corner lies in.
class BlockMap {
  public:
    using Grid = nanovdb::NanoGrid<nanovdb::Fp16>;

    enum class Kind {
        voxels,  // values of its own
        tile,    // one value that is not zero
        edge,    // zero, but beside blocks that are not: the last cells have corners there
        empty,   // zero at all corners of all cells
    };

    /// Null where the box, `support` as of NanoGrid, has so many blocks for what is in them that
    /// the map would be larger than the grid.
    static std::shared_ptr<const BlockMap> of(const Grid& grid, const Bounds& support);

    /// Empty outside the box.
    Kind kind(const nanovdb::Coord& cell) const {
        const std::uint8_t code = code_at(cell);
        return code < k_first_kind ? Kind::empty : static_cast<Kind>(code - k_first_kind);
    }
    /// Of a cell in an empty block: a box [low, high) of cells around it that are empty.
    void find_empty(const nanovdb::Coord& cell, nanovdb::Coord& low, nanovdb::Coord& high) const {
        const int beyond = code_at(cell) * k_edge;  // its own block
        low = (cell & ~(k_edge - 1)).offsetBy(-beyond);
        high = low.offsetBy(2 * beyond + k_edge);
    }

  private:
    static constexpr int k_edge = 8, k_edge_bits = 3;
    // Codes below are those of empty blocks: how many blocks beyond them are empty on all sides.
    static constexpr std::uint8_t k_first_kind = 252;

    BlockMap(const Grid& grid, const Bounds& support);
    void mark(Kind kind, const nanovdb::Coord& low, int edge);
    void find_edges();
    void find_distances();

    std::uint8_t code_at(const nanovdb::Coord& cell) const {
        std::array<unsigned, 3> at{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            at[axis] = static_cast<unsigned>((cell[int(axis)] >> k_edge_bits) - first_[axis]);
            if (at[axis] >= size_[axis]) return 0;
        }
        return codes_[index(at[0], at[1], at[2])];
    }
    std::size_t index(std::size_t x, std::size_t y, std::size_t z) const {
        return (x * size_[1] + y) * size_[2] + z;
    }

    std::array<int, 3> first_{};  // the box in blocks
    std::array<unsigned, 3> size_{};
    std::vector<std::uint8_t> codes_;
};

}  // namespace uw
