#include "media/vdb/nano_grid.h"

#include <nanovdb/NanoVDB.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"
#include "media/vdb/vdb_header.h"

namespace uw {
namespace {

using Build = nanovdb::Fp16;
using Grid = nanovdb::NanoGrid<Build>;
using Leaf = nanovdb::NanoLeaf<Build>;
using Accessor = nanovdb::ReadAccessor<Build, 0, 1, 2>;
using nanovdb::Coord;

constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// The eight values at the corners of an interpolation cell; [4 * dx + 2 * dy + dz].
struct Corners {
    std::array<float, 8> v;

    double interpolate(double fx, double fy, double fz) const {
        const auto lerp = [](double a, double b, double f) { return a + f * (b - a); };
        const auto edge = [&](std::size_t at) {
            return lerp(static_cast<double>(v[at]), static_cast<double>(v[at + 1]), fz);
        };
        return lerp(lerp(edge(0), edge(2), fy), lerp(edge(4), edge(6), fy), fx);
    }
    bool zero() const {
        return std::all_of(v.begin(), v.end(), [](float value) { return value == 0; });
    }
};

Corners corners_of(const Accessor& accessor, const Leaf* leaf, const Coord& cell) {
    Corners corners{};
    constexpr int last = k_leaf_edge - 1;
    const int x = cell[0] & last, y = cell[1] & last, z = cell[2] & last;
    if (leaf != nullptr && x != last && y != last && z != last) {
        const auto n = static_cast<std::uint32_t>((x << 6) | (y << 3) | z);
        constexpr std::array<std::uint32_t, 8> offsets{0, 1, 8, 9, 64, 65, 72, 73};
        for (std::size_t i = 0; i < 8; ++i) corners.v[i] = leaf->getValue(n + offsets[i]);
        return corners;
    }
    for (int i = 0; i < 8; ++i)
        corners.v[static_cast<std::size_t>(i)] =
            accessor.getValue(cell + Coord(i >> 2, (i >> 1) & 1, i & 1));
    return corners;
}

Coord floor_of(const Point3& p) {  // p lies within 2^30 of the origin
    return {static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)),
            static_cast<int>(std::floor(p.z))};
}

bool contains(const Bounds& box, const Point3& p) {
    return p.x >= box.min.x && p.x <= box.max.x && p.y >= box.min.y && p.y <= box.max.y &&
           p.z >= box.min.z && p.z <= box.max.z;
}

/// Samples consecutive points: neighbours in the same cell share its corners.
class Sampler {
  public:
    Sampler(const void* grid, const Bounds& support)
        : accessor_(*static_cast<const Grid*>(grid)), support_(support) {}

    double operator()(const Point3& p) {
        if (!contains(support_, p)) return 0;  // also if p is NaN
        const Coord cell = floor_of(p);
        if (cell != cell_) {
            corners_ = corners_of(accessor_, accessor_.probeLeaf(cell), cell);
            cell_ = cell;
        }
        return corners_.interpolate(p.x - cell[0], p.y - cell[1], p.z - cell[2]);
    }

  private:
    Accessor accessor_;
    const Bounds& support_;
    Coord cell_{std::numeric_limits<int>::max()};
    Corners corners_{};
};

/// The grid's contents around a cell, and the box of cells that share them.
struct Region {
    enum class Kind { constant, leaf, cell };
    Kind kind = Kind::cell;
    float value = 0;             // constant
    const Leaf* leaf = nullptr;  // leaf
    Coord low{0}, high{0};       // cells [low, high)
};

/// Cells whose eight corners lie in one tile are constant; a tile's last layer of cells touches its
/// neighbours and is taken cell by cell, so that no dilated copy of the topology is needed.
Region region_at(const Accessor& accessor, const Coord& cell) {
    Region region;
    region.leaf = accessor.probeLeaf(cell);
    if (region.leaf != nullptr) {
        region.kind = Region::Kind::leaf;
        region.low = cell & ~(k_leaf_edge - 1);
        region.high = region.low.offsetBy(k_leaf_edge);
        return region;
    }
    const int dim = static_cast<int>(accessor.getDim(cell, 0));
    region.low = cell & ~(dim - 1);
    region.high = region.low.offsetBy(dim - 1);
    if (cell[0] < region.high[0] && cell[1] < region.high[1] && cell[2] < region.high[2]) {
        region.kind = Region::Kind::constant;
        region.value = accessor.getValue(cell);
        return region;
    }
    region.low = cell;
    region.high = cell.offsetBy(1);
    return region;
}

/// Walks a line through the cells of the interpolation lattice. The cell only ever advances along
/// each axis in the line's direction, so the walk terminates.
class Walk {
  public:
    Walk(const LatticeLine& line, double begin, double end, const Bounds& support) : line_(line) {
        t_ = begin;
        end_ = end;
        for (int axis = 0; axis < 3; ++axis) {
            const double d = line.direction[axis];
            if (std::abs(d) < 1e-200) {  // parallel to this axis's faces
                const double p = line.origin[axis];
                if (!(p >= support.min[axis] && p <= support.max[axis])) end_ = -k_infinity;
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
    const Coord& cell() const { return cell_; }

    /// Advances to where the line leaves the cells [low, high), or ends, and returns that
    /// parameter.
    double leave(const Coord& low, const Coord& high) {
        double exit = k_infinity;
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
        const bool one_cell = high[0] - low[0] == 1;
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
    Coord cell_{0}, first_{0}, last_{0};
    std::array<int, 3> sign_{};
    Vector3 inverse_{0};
};

/// Integral over [t0, t1] of the interpolated value within one cell. Along a line it is a cubic,
/// for which two Gauss points are exact.
double integrate_cell(const Corners& corners, const Coord& cell, const LatticeLine& line, double t0,
                      double t1) {
    constexpr double half_gap = 0.28867513459481288225;  // 1 / (2 sqrt 3)
    const double middle = 0.5 * (t0 + t1), length = t1 - t0;
    const auto at = [&](double t) {
        return corners.interpolate(line.origin.x - cell[0] + t * line.direction.x,
                                   line.origin.y - cell[1] + t * line.direction.y,
                                   line.origin.z - cell[2] + t * line.direction.z);
    };
    return 0.5 * length * (at(middle - half_gap * length) + at(middle + half_gap * length));
}

void append(std::vector<GridStretch>& stretches, std::size_t first, const GridStretch& next) {
    if (!(next.end > next.begin)) return;
    if (stretches.size() > first && stretches.back().end == next.begin &&
        stretches.back().constant == next.constant && !next.constant)
        stretches.back().end = next.end;
    else
        stretches.push_back(next);
}

}  // namespace

NanoGrid::NanoGrid(std::shared_ptr<const void> storage, const void* grid, std::size_t bytes,
                   const std::array<int, 3>& min, const std::array<int, 3>& max)
    : storage_(std::move(storage)), grid_(grid), bytes_(bytes) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        support_.min[axis] = min[at] - 1.0;
        support_.max[axis] = max[at] + 1.0;
    }
}

double NanoGrid::sample(const Point3& p) const {
    return Sampler(grid_, support_)(p);
}

void NanoGrid::add_samples(const LatticeLine& line, std::span<const double> t,
                           std::span<double> values) const {
    Sampler sampler(grid_, support_);
    for (std::size_t n = 0; n < t.size(); ++n)
        values[n] += sampler(line.origin + t[n] * line.direction);
}

double NanoGrid::integrate(const LatticeLine& line) const {
    const Accessor accessor(*static_cast<const Grid*>(grid_));
    double integral = 0;
    Region region;
    Walk walk(line, 0, 1, support_);
    while (!walk.done()) {
        const Coord cell = walk.cell();
        const bool same_leaf = region.leaf != nullptr && (cell & ~(k_leaf_edge - 1)) == region.low;
        if (!same_leaf) region = region_at(accessor, cell);
        const double begin = walk.t();
        if (region.kind == Region::Kind::constant) {
            const double end = walk.leave(region.low, region.high);
            integral += static_cast<double>(region.value) * (end - begin);
            continue;
        }
        const double end = walk.leave(cell, cell.offsetBy(1));
        if (end > begin)
            integral +=
                integrate_cell(corners_of(accessor, region.leaf, cell), cell, line, begin, end);
    }
    return integral;
}

void NanoGrid::append_stretches(const LatticeLine& line, double begin, double end,
                                std::vector<GridStretch>& stretches) const {
    const Accessor accessor(*static_cast<const Grid*>(grid_));
    const std::size_t first = stretches.size();
    Walk walk(line, begin, end, support_);
    while (!walk.done()) {
        const Coord cell = walk.cell();
        const Region region = region_at(accessor, cell);
        const bool constant = region.kind == Region::Kind::constant;
        const bool empty =
            (constant && region.value == 0) ||
            (region.kind == Region::Kind::cell && corners_of(accessor, nullptr, cell).zero());
        const double from = walk.t();
        const double to = walk.leave(region.low, region.high);
        if (!empty) append(stretches, first, {from, to, constant});
    }
}

double NanoGrid::stored_sum() const {
    const auto& tree = static_cast<const Grid*>(grid_)->tree();
    const Leaf* blocks = tree.getFirstLeaf();
    const std::size_t count = tree.nodeCount(0);
    constexpr std::size_t k_chunk = 128;
    std::vector<double> sums((count + k_chunk - 1) / k_chunk);
    parallel_for(sums.size(), [&](std::size_t chunk) {
        const std::size_t end = std::min(count, (chunk + 1) * k_chunk);
        for (std::size_t i = chunk * k_chunk; i < end; ++i) {
            const auto* block = blocks[i].data();
            // 512 codes of 16 bits do not overflow.
            const std::uint32_t codes =
                std::accumulate(std::begin(block->mCode), std::end(block->mCode), 0U);
            sums[chunk] +=
                static_cast<double>(block->mQuantum) * codes +
                static_cast<double>(block->mMinimum) * static_cast<double>(std::size(block->mCode));
        }
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace uw
