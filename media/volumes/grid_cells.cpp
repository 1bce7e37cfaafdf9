#include "media/volumes/grid_cells.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

namespace uw {

namespace {

constexpr int k_root_bits = 12;  // of the edge of a root's block
static_assert(nanovdb::NanoUpper<nanovdb::Fp16>::DIM == 1 << k_root_bits);
constexpr int k_first_voxel = -(1 << 30);  // NanoGrid's limit
constexpr unsigned k_key_bits = 20;        // per axis

std::uint64_t key_of(const nanovdb::Coord& voxel) {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis)
        key = key << k_key_bits |
              static_cast<std::uint64_t>(std::int64_t{voxel[axis]} - k_first_voxel) >> k_root_bits;
    return key;
}

/// The key of the block of 2^level times the edge that contains it.
std::uint64_t key_above(std::uint64_t key, unsigned level) {
    std::uint64_t above = 0;
    for (int axis = 2; axis >= 0; --axis) {
        const unsigned shift = static_cast<unsigned>(axis) * k_key_bits;
        above = above << k_key_bits | (key >> shift & ((1U << k_key_bits) - 1)) >> level;
    }
    return above;
}

}  // namespace

RootBlocks::RootBlocks(const Grid& grid) {
    const auto& root = *grid.tree().root().data();
    for (std::uint32_t n = 0; n < root.mTableSize; ++n) {
        const auto& tile = *root.tile(n);
        entries_.push_back({key_of(tile.origin()), tile.value, tile.isChild()});
    }
    std::ranges::sort(entries_, {}, &Entry::key);
    for (unsigned level = 1; occupied_.empty() || occupied_.back().size() > 1; ++level) {
        std::vector<std::uint64_t> keys;
        for (const Entry& entry : entries_) keys.push_back(key_above(entry.key, level));
        std::ranges::sort(keys);
        keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
        occupied_.push_back(std::move(keys));
    }
}

bool RootBlocks::are_many(const Grid& grid) {
    constexpr std::uint32_t k_few = 8;  // around the origin
    const auto& root = *grid.tree().root().data();
    if (root.mTableSize > k_few) return true;
    for (std::uint32_t n = 1; n < root.mTableSize; ++n)
        for (int axis = 0; axis < 3; ++axis)
            if (std::abs(std::int64_t{root.tile(n)->origin()[axis]} -
                         root.tile(0)->origin()[axis]) > std::int64_t{k_few} << k_root_bits)
                return true;
    return false;
}

RootBlocks::Block RootBlocks::at(const nanovdb::Coord& voxel) const {
    const std::uint64_t key = key_of(voxel);
    const auto found = std::ranges::lower_bound(entries_, key, {}, &Entry::key);
    if (found != entries_.end() && found->key == key)
        return {1 << k_root_bits, found->value, found->has_nodes};
    unsigned level = 0;
    while (level < occupied_.size() &&
           !std::ranges::binary_search(occupied_[level], key_above(key, level + 1)))
        ++level;
    return {1 << (k_root_bits + static_cast<int>(level)), 0, false};
}

bool CellReader::find(unsigned side) {
    static constexpr std::array<std::uint16_t, k_edge * k_edge * k_edge> k_zeros{};
    const auto offset = [&](unsigned bit) { return (side & bit) != 0 ? k_edge : 0; };
    const Coord voxel = low_.offsetBy(offset(4), offset(2), offset(1));
    known_ |= 1U << side;
    const Leaf* const own = leaf(voxel);
    if (own != nullptr)
        blocks_[side] = {own->data()->mCode, own->data()->mMinimum, own->data()->mQuantum};
    else
        blocks_[side] = {k_zeros.data(), value(voxel), 0};
    return own != nullptr;
}

CellCorners CellReader::one_by_one(const Coord& cell) const {
    CellCorners::Four at_z{}, at_next_z{};
    for (int i = 0; i < 4; ++i) {
        at_z[i] = value(cell.offsetBy(i >> 1, i & 1, 0));
        at_next_z[i] = value(cell.offsetBy(i >> 1, i & 1, 1));
    }
    return {at_z, at_next_z};
}

namespace {

using Place = std::array<int, 3>;

Place place(unsigned cell) {
    return {static_cast<int>(cell >> 8), static_cast<int>(cell >> 4 & 15U),
            static_cast<int>(cell & 15U)};
}

}  // namespace

LineIntegral::LineIntegral(const LatticeLine& line) : line_(line) {
    const Vector3& d = line.direction;
    products_ = Vector3(d.y * d.z, d.x * d.z, d.x * d.y) / 12.0;
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(d[axis]) >= 1e-200) inverse_[axis] = 1 / d[axis];
    across_ = glm::abs(inverse_);
}

double LineIntegral::over_cell(const CellCorners& corners, const nanovdb::Coord& cell, double begin,
                               double end) const {
    const double length = end - begin;
    const Point3 p = line_.origin + 0.5 * (begin + end) * line_.direction;
    return length *
           corners.mean({p.x - cell[0], p.y - cell[1], p.z - cell[2]}, length * length * products_);
}

// Finds the pieces first, without a branch that depends on the cell, which would be mispredicted,
// and then integrates those within the block and those at its faces.
double LineIntegral::over_block(CellReader& reader, double begin, double end) {
    find_pieces(reader.low(), begin, end);
    double integral = 0;
    for (std::size_t n = 0; n < inside_count_; ++n) {
        const std::size_t i = inside_[n];
        const auto [x, y, z] = place(cells_[i]);
        integral += over_piece(reader.inside(x, y, z), i);
    }
    for (std::size_t n = 0; n < face_count_; ++n) {
        const std::size_t i = at_faces_[n];
        const auto [x, y, z] = place(cells_[i]);
        integral += over_piece(reader.at_face(x, y, z), i);
    }
    return integral;
}

void LineIntegral::find_pieces(const nanovdb::Coord& low, double begin, double end) {
    unsigned cell = 0;
    std::array<unsigned, 3> step{};
    Vector3 next(std::numeric_limits<double>::infinity());  // where the cell is left
    for (int axis = 0; axis < 3; ++axis) {
        origin_[axis] = line_.origin[axis] - low[axis];
        const double p = origin_[axis] + begin * line_.direction[axis];
        const int at = static_cast<int>(std::clamp(p, 0.0, CellReader::k_edge - 1.0));
        const int shift = 8 - 4 * axis;
        cell |= static_cast<unsigned>(at) << shift;
        if (inverse_[axis] == 0) continue;
        const bool ascending = inverse_[axis] > 0;
        step[axis] = ascending ? 1U << shift : ~0U << shift;
        next[axis] = (at + (ascending ? 1 : 0) - origin_[axis]) * inverse_[axis];
    }
    inside_count_ = face_count_ = 0;
    knots_[0] = begin;
    for (std::size_t i = 0; i < k_max_pieces; ++i) {
        const double exit = std::max(begin, std::min({next.x, next.y, next.z, end}));
        cells_[i] = cell;
        knots_[i + 1] = exit;
        inside_[inside_count_] = at_faces_[face_count_] = static_cast<std::uint8_t>(i);
        const std::size_t at_face = ((cell + 0x111U) & 0x888U) != 0 ? 1 : 0;
        face_count_ += at_face;
        inside_count_ += 1 - at_face;
        cell += (next.x <= exit ? step[0] : 0) + (next.y <= exit ? step[1] : 0) +
                (next.z <= exit ? step[2] : 0);
        // Rounding may put the end of the last cell before that of the block.
        if (exit >= end || (cell & ~0x777U) != 0) return;
        next.x += next.x <= exit ? across_.x : 0;
        next.y += next.y <= exit ? across_.y : 0;
        next.z += next.z <= exit ? across_.z : 0;
    }
}

double LineIntegral::over_piece(const CellCorners& corners, std::size_t i) const {
    const double length = knots_[i + 1] - knots_[i];
    const auto [x, y, z] = place(cells_[i]);
    const Point3 p = origin_ + 0.5 * (knots_[i] + knots_[i + 1]) * line_.direction;
    return length * corners.mean({p.x - x, p.y - y, p.z - z}, length * length * products_);
}

}  // namespace uw
