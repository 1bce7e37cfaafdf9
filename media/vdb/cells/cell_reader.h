#pragma once

#include <nanovdb/NanoVDB.h>

#include <array>
#include <cstdint>
#include <limits>

#include "media/vdb/cells/cell_corners.h"

namespace uw {

/// Reads the corners of cells that follow each other along a line: neighbours mostly lie in the
/// same block of 8^3 voxels, and those at its faces share the blocks beside it.
class CellReader {
  public:
    using Build = nanovdb::Fp16;
    using Grid = nanovdb::NanoGrid<Build>;
    using Accessor = nanovdb::ReadAccessor<Build, 0, 1, 2>;
    using Coord = nanovdb::Coord;
    static constexpr int k_edge = nanovdb::NanoLeaf<Build>::DIM;  // of a block [voxels]
    static_assert(k_edge == 8);

    explicit CellReader(const void* grid) : accessor_(*static_cast<const Grid*>(grid)) {}

    /// Whether the cell's lowest corner lies in a block, whose cells `in_block` then reads.
    bool enter(const Coord& cell) {
        const Coord low = cell & ~(k_edge - 1);
        if (low != low_) {
            low_ = low;
            known_ = 0;
            in_block_ = find(0);
        }
        return in_block_;
    }
    const Accessor& accessor() const { return accessor_; }
    /// The first cell of the block that was entered last.
    const Coord& low() const { return low_; }

    /// The corners of a cell of the block that was entered last, counted from its first.
    CellCorners in_block(int x, int y, int z) {
        constexpr int last = k_edge - 1;
        return x == last || y == last || z == last ? at_face(x, y, z) : inside(x, y, z);
    }
    /// The same away from the faces that other blocks follow: all coordinates are less than 7.
    CellCorners inside(int x, int y, int z) const {
        const Block& block = blocks_[0];
        const std::uint16_t* const first = block.codes + place(x, y, z);
        const Codes at_z{first[0], first[8], first[64], first[72]};
        const Codes at_next_z{first[1], first[9], first[65], first[73]};
        return {values(block, at_z), values(block, at_next_z)};
    }
    /// The same at one of those faces.
    CellCorners at_face(int x, int y, int z) {
        const auto sides =
            static_cast<unsigned>((x + 1) >> 3 << 2 | (y + 1) >> 3 << 1 | (z + 1) >> 3);
        if (unsigned missing = k_sides[sides] & ~known_; missing != 0)
            for (unsigned side = 0; side < 8; ++side)
                if ((missing >> side & 1U) != 0) find(side);
        CellCorners::Four at_z{}, at_next_z{};
        for (int i = 0; i < 4; ++i) {
            at_z[i] = value(x + (i >> 1), y + (i & 1), z);
            at_next_z[i] = value(x + (i >> 1), y + (i & 1), z + 1);
        }
        return {at_z, at_next_z};
    }
    /// The corners of any cell.
    CellCorners corners(const Coord& cell) {
        if (!enter(cell)) return one_by_one(cell);
        return in_block(cell[0] - low_[0], cell[1] - low_[1], cell[2] - low_[2]);
    }

  private:
    /// The values of 8^3 voxels: least + quantum * code.
    struct Block {
        const std::uint16_t* codes = nullptr;
        float least = 0, quantum = 0;
    };
    using Codes = std::int32_t __attribute__((vector_size(16)));

    static CellCorners::Four values(const Block& block, const Codes& codes) {
        return __builtin_convertvector(codes, CellCorners::Four) * block.quantum + block.least;
    }
    static int place(int x, int y, int z) { return x << 6 | y << 3 | z; }

    // Of a voxel of the block or one of those that follow it, counted from its first.
    float value(int x, int y, int z) const {
        const Block& block = blocks_[static_cast<std::size_t>(x >> 3 << 2 | y >> 3 << 1 | z >> 3)];
        return static_cast<float>(block.codes[place(x & 7, y & 7, z & 7)]) * block.quantum +
               block.least;
    }
    // Finds the block that was entered or one of those that follow it, and whether it has values of
    // its own: constant regions look like blocks.
    bool find(unsigned side);
    CellCorners one_by_one(const Coord& cell) const;

    // The blocks that the corners of a cell at the faces 4 x + 2 y + z lie in, a bit for each.
    static constexpr std::array<unsigned, 8> k_sides{0x01, 0x03, 0x05, 0x0f,
                                                     0x11, 0x33, 0x55, 0xff};

    Accessor accessor_;
    Coord low_{std::numeric_limits<int>::max()};
    bool in_block_ = false;
    // The block entered, and those that follow it: [4 dx + 2 dy + dz].
    std::array<Block, 8> blocks_{};
    unsigned known_ = 0;  // a bit for each
};

}  // namespace uw
