#include "media/volumes/grid_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace uw {

bool CellReader::find(unsigned side) {
    static constexpr std::array<std::uint16_t, k_edge * k_edge * k_edge> k_zeros{};
    const auto offset = [&](unsigned bit) { return (side & bit) != 0 ? k_edge : 0; };
    const Coord voxel = low_.offsetBy(offset(4), offset(2), offset(1));
    known_ |= 1U << side;
    const auto* leaf = accessor_.probeLeaf(voxel);
    if (leaf != nullptr)
        blocks_[side] = {leaf->data()->mCode, leaf->data()->mMinimum, leaf->data()->mQuantum};
    else
        blocks_[side] = {k_zeros.data(), accessor_.getValue(voxel), 0};
    return leaf != nullptr;
}

CellCorners CellReader::one_by_one(const Coord& cell) const {
    CellCorners::Four at_z{}, at_next_z{};
    for (int i = 0; i < 4; ++i) {
        at_z[i] = accessor_.getValue(cell.offsetBy(i >> 1, i & 1, 0));
        at_next_z[i] = accessor_.getValue(cell.offsetBy(i >> 1, i & 1, 1));
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

// Finds the pieces first, without a branch that depends on the cell, so that processors need not
// guess the axis of the next face, and then integrates those within the block and those at its
// faces.
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
    for (std::size_t i = 0; i < k_most_pieces; ++i) {
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
