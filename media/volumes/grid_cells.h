#pragma once

#include <nanovdb/NanoVDB.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "media/volumes/lattice_cell.h"

namespace uw {

/// An index of the root of a grid's tree: its blocks of 4096^3 voxels that have nodes below them or
/// one value, and the empty space between them in blocks as large as possible. NanoVDB's accessor
/// searches the root's whole table for each voxel outside the cached nodes, and has no empty blocks
/// larger than a root's: the time for a line through a few distant voxels, or through many blocks
/// of one value, would grow with the width of the grid.
class RootBlocks {
  public:
    using Grid = nanovdb::NanoGrid<nanovdb::Fp16>;

    explicit RootBlocks(const Grid& grid);

    /// Whether the root has so many blocks, or so distant ones, that the index pays.
    static bool are_many(const Grid& grid);

    struct Block {
        int edge = 0;  // [voxels], a power of two, at a multiple of which it begins
        float value = 0;
        bool has_nodes = false;  // below it, which contain the values
    };
    Block at(const nanovdb::Coord& voxel) const;

  private:
    struct Entry {
        std::uint64_t key = 0;
        float value = 0;
        bool has_nodes = false;
    };
    std::vector<Entry> entries_;  // by key
    // The blocks of twice, four times ... the edge that are not empty, up to the one that contains
    // all.
    std::vector<std::vector<std::uint64_t>> occupied_;
};

/// Reads the corners of cells that follow each other along a line: neighbours mostly lie in the
/// same block of 8^3 voxels, and those at its faces share the blocks beside it.
class CellReader {
  public:
    using Build = nanovdb::Fp16;
    using Grid = nanovdb::NanoGrid<Build>;
    using Leaf = nanovdb::NanoLeaf<Build>;
    using Accessor = nanovdb::ReadAccessor<Build, 0, 1, 2>;
    using Coord = nanovdb::Coord;
    static constexpr int k_edge = nanovdb::NanoLeaf<Build>::DIM;  // of a block [voxels]
    static_assert(k_edge == 8);

    /// `roots`: null if the grid's root has but a few blocks; else must outlive this object.
    CellReader(const void* grid, const RootBlocks* roots)
        : accessor_(*static_cast<const Grid*>(grid)), roots_(roots) {}

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
    /// The block of 8^3 voxels that contains a voxel; null if it lies in a larger one of one value.
    const Leaf* leaf(const Coord& voxel) const {
        if (roots_ != nullptr && !root_block(voxel).has_nodes) return nullptr;
        return accessor_.probeLeaf(voxel);
    }
    float value(const Coord& voxel) const {
        if (roots_ != nullptr)
            if (const RootBlocks::Block& block = root_block(voxel); !block.has_nodes)
                return block.value;
        return accessor_.getValue(voxel);
    }
    /// The edge of the block of one value that contains a voxel without a leaf.
    int edge(const Coord& voxel) const {
        if (roots_ != nullptr)
            if (const RootBlocks::Block& block = root_block(voxel); !block.has_nodes)
                return block.edge;
        return static_cast<int>(accessor_.getDim(voxel, 0));
    }
    /// The first cell of the block that was entered last.
    const Coord& low() const { return low_; }

    /// The corners of a cell of the block that was entered last, counted from its first.
    CellCorners in_block(int x, int y, int z) {
        constexpr int last = k_edge - 1;
        return x == last || y == last || z == last ? at_face(x, y, z) : inside(x, y, z);
    }
    /// in_block() for cells away from the faces to other blocks, where all coordinates are less
    /// than 7.
    CellCorners inside(int x, int y, int z) const {
        const Block& block = blocks_[0];
        const std::uint16_t* const first = block.codes + place(x, y, z);
        const Codes at_z{first[0], first[8], first[64], first[72]};
        const Codes at_next_z{first[1], first[9], first[65], first[73]};
        return {values(block, at_z), values(block, at_next_z)};
    }
    /// in_block() for cells at one of those faces.
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

    // The value of a voxel of the block or of one of those that follow it; coordinates count from
    // the block's first voxel.
    float value(int x, int y, int z) const {
        const Block& block = blocks_[static_cast<std::size_t>(x >> 3 << 2 | y >> 3 << 1 | z >> 3)];
        return static_cast<float>(block.codes[place(x & 7, y & 7, z & 7)]) * block.quantum +
               block.least;
    }
    // Finds the block that was entered or one of those that follow it, and returns whether it has
    // values of its own: constant regions look like blocks.
    bool find(unsigned side);
    CellCorners one_by_one(const Coord& cell) const;

    // The blocks that the corners of a cell at the faces 4 x + 2 y + z lie in, a bit for each.
    static constexpr std::array<unsigned, 8> k_sides{0x01, 0x03, 0x05, 0x0f,
                                                     0x11, 0x33, 0x55, 0xff};

    const RootBlocks::Block& root_block(const Coord& voxel) const {
        if ((voxel & ~(root_block_.edge - 1)) != root_low_ || root_block_.edge == 0) {
            root_block_ = roots_->at(voxel);
            root_low_ = voxel & ~(root_block_.edge - 1);
        }
        return root_block_;
    }

    Accessor accessor_;
    const RootBlocks* roots_ = nullptr;
    mutable RootBlocks::Block root_block_;  // the last one found, and where it begins
    mutable Coord root_low_{std::numeric_limits<int>::max()};
    Coord low_{std::numeric_limits<int>::max()};
    bool in_block_ = false;
    // The block entered, and those that follow it: [4 dx + 2 dy + dz].
    std::array<Block, 8> blocks_{};
    unsigned known_ = 0;  // a bit for each
};

/// Integrals of the interpolated values along parts of a line, cell by cell, in units of its
/// parameter.
class LineIntegral {
  public:
    /// `line` must outlive this object.
    explicit LineIntegral(const LatticeLine& line);

    /// The integral over [begin, end], which lies within one cell.
    double over_cell(const CellCorners& corners, const nanovdb::Coord& cell, double begin,
                     double end) const;

    /// The integral over [begin, end], which lies within the block that `reader` has entered.
    double over_block(CellReader& reader, double begin, double end);

  private:
    // A line meets at most this many of a block's cells.
    static constexpr int k_max_pieces = 3 * CellReader::k_edge;

    void find_pieces(const nanovdb::Coord& low, double begin, double end);
    double over_piece(const CellCorners& corners, std::size_t i) const;

    const LatticeLine& line_;
    Vector3 products_{0};  // of the direction's components yz, xz and xy, over twelve
    Vector3 inverse_{0};   // 0 parallel to the axis's faces
    Vector3 across_{0};    // a cell, in the line's parameter
    Point3 origin_;        // of the line, counted from the block's first cell
    // The pieces of the block's last line: cells, counted from its first, with a hexadecimal digit
    // each for x, y and z, and where they begin and end.
    std::array<unsigned, k_max_pieces> cells_;
    std::array<double, k_max_pieces + 1> knots_;
    // The indices of pieces in cells with all corners in the block, and of pieces in other cells.
    std::array<std::uint8_t, k_max_pieces + 1> inside_, at_faces_;
    std::size_t inside_count_ = 0, face_count_ = 0;
};

/// Walks a line through the cells of the interpolation lattice. The cell only ever advances along
/// each axis in the line's direction, so the walk terminates.
class LatticeWalk {
  public:
    LatticeWalk(const LatticeLine& line, double begin, double end, const Bounds& support)
        : line_(line) {
        t_ = begin;
        end_ = end;
        for (int axis = 0; axis < 3; ++axis) {
            const double d = line.direction[axis];
            if (std::abs(d) < 1e-200) {  // parallel to this axis's faces
                const double p = line.origin[axis];
                if (!(p >= support.min[axis] && p <= support.max[axis]))
                    end_ = -std::numeric_limits<double>::infinity();
                continue;
            }
            sign_[axis] = d > 0 ? 1 : -1;
            inverse_[axis] = 1 / d;
            const double a = (support.min[axis] - line.origin[axis]) * inverse_[axis];
            const double b = (support.max[axis] - line.origin[axis]) * inverse_[axis];
            t_ = std::max(t_, std::min(a, b));
            end_ = std::min(end_, std::max(a, b));
        }
        if (done()) return;
        for (int axis = 0; axis < 3; ++axis) {
            first_[axis] = static_cast<int>(support.min[axis]);
            last_[axis] = static_cast<int>(support.max[axis]) - 1;
            const double p = line.origin[axis] + t_ * line.direction[axis];
            cell_[axis] = std::clamp(static_cast<int>(std::floor(std::clamp(p, -2e9, 2e9))),
                                     first_[axis], last_[axis]);
        }
    }

    bool done() const { return !(t_ < end_); }
    double t() const { return t_; }
    const nanovdb::Coord& cell() const { return cell_; }

    /// Advances to where the line leaves the cells [low, high), or ends, and returns that
    /// parameter.
    double leave(const nanovdb::Coord& low, const nanovdb::Coord& high) {
        double exit = std::numeric_limits<double>::infinity();
        int exit_axis = 0;
        for (int axis = 0; axis < 3; ++axis) {
            if (sign_[axis] == 0) continue;
            const int face = sign_[axis] > 0 ? high[axis] : low[axis];
            const double t = (face - line_.origin[axis]) * inverse_[axis];
            if (t < exit) {
                exit = t;
                exit_axis = axis;
            }
        }
        if (!(exit < end_)) {
            t_ = end_;
            return t_;
        }
        t_ = std::max(t_, exit);
        const bool one_cell = high == low.offsetBy(1);
        for (int axis = 0; axis < 3; ++axis) {
            if (axis == exit_axis)
                cell_[axis] = sign_[axis] > 0 ? high[axis] : low[axis] - 1;
            else if (!one_cell && sign_[axis] != 0)
                move_within(axis, low[axis], high[axis] - 1);
        }
        if (cell_[exit_axis] < first_[exit_axis] || cell_[exit_axis] > last_[exit_axis])
            end_ = t_;  // left the support
        return t_;
    }

  private:
    void move_within(int axis, int low, int high) {
        const double p = std::floor(line_.origin[axis] + t_ * line_.direction[axis]);
        if (sign_[axis] > 0)
            low = std::max(low, cell_[axis]);
        else
            high = std::min(high, cell_[axis]);
        cell_[axis] =
            static_cast<int>(std::clamp(p, static_cast<double>(low), static_cast<double>(high)));
    }

    const LatticeLine& line_;
    double t_ = 0, end_ = 0;
    nanovdb::Coord cell_{0}, first_{0}, last_{0};
    std::array<int, 3> sign_{};
    Vector3 inverse_{0};
};

}  // namespace uw
