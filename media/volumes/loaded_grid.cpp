#include "media/volumes/loaded_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "media/volumes/block_map.h"
#include "media/volumes/grid_cells.h"

namespace uw {

GridStatistics GridIntake::statistics(double background) const {
    GridStatistics statistics{active, nan, infinite, negative, background, 0, 0, 0};
    if (active == 0) return statistics;
    statistics.min = static_cast<double>(min);
    statistics.max = static_cast<double>(max);
    statistics.mean = sum / static_cast<double>(active);
    return statistics;
}

std::vector<std::string> intake_warnings(const GridStatistics& statistics,
                                         const std::string& prefix) {
    std::vector<std::string> warnings;
    const auto warn = [&](const std::string& what) { warnings.push_back(prefix + what); };
    const auto count = [&](std::int64_t voxels, const char* what) {
        if (voxels > 0)
            warn(fmt::format("{} of {} active voxels are {}: treated as 0", voxels,
                             statistics.active_voxels, what));
    };
    count(statistics.nan_voxels, "NaN");
    count(statistics.infinite_voxels, "infinite");
    count(statistics.negative_voxels, "negative");
    if (statistics.background != 0)
        warn(fmt::format("its background is {:g}: treated as 0 outside the active voxels",
                         statistics.background));
    if (statistics.active_voxels == 0)
        warn("it has no active voxels and contributes nothing");
    else if (statistics.max == 0)
        warn("all its active voxels are 0 and it contributes nothing");
    return warnings;
}

namespace {

using nanovdb::Coord;
using Grid = CellReader::Grid;

/// Samples consecutive points: neighbours in the same cell share its corners.
class Sampler {
  public:
    Sampler(const void* grid, const RootBlocks* roots, const Bounds& support)
        : reader_(grid, roots),
          min_(support.min),
          max_(support.max),
          low_(static_cast<int>(min_.x), static_cast<int>(min_.y), static_cast<int>(min_.z)) {}

    double operator()(const Point3& p) {
        const bool within = p.x >= min_.x && p.x <= max_.x && p.y >= min_.y && p.y <= max_.y &&
                            p.z >= min_.z && p.z <= max_.z;
        if (!within) return 0;  // also if p is NaN
        const Coord cell =
            low_.offsetBy(static_cast<int>(p.x - min_.x), static_cast<int>(p.y - min_.y),
                          static_cast<int>(p.z - min_.z));
        if (cell != cell_) {
            corners_ = reader_.corners(cell);
            cell_ = cell;
        }
        return corners_.at({p.x - cell[0], p.y - cell[1], p.z - cell[2]});
    }

  private:
    CellReader reader_;
    Point3 min_, max_;  // of the support, whose corners are voxels
    Coord low_, cell_{std::numeric_limits<int>::max()};
    CellCorners corners_;
};

/// The grid's contents around a cell, and the box of cells that share them.
struct Region {
    enum class Kind { constant, leaf, cells };
    Kind kind = Kind::cells;
    float value = 0;        // constant
    Coord low{0}, high{0};  // cells [low, high)
};

/// The cells beside `cell` whose eight corners lie in the same tiles as its own. If the tiles have
/// one value, these are constant; if not, they have the same corners, and are one layer thick
/// across the faces between tiles. A line along such a face, however long, meets no more of them
/// than tiles, and no dilated copy of the topology is needed. Beside a block it is the cell alone.
Region between_tiles(const CellReader& reader, const Coord& cell) {
    Region region;
    region.kind = Region::Kind::constant;
    region.value = reader.value(cell);
    region.low = Coord(std::numeric_limits<int>::min());
    region.high = Coord(std::numeric_limits<int>::max());
    for (int corner = 0; corner < 8; ++corner) {
        const Coord offset(corner >> 2, corner >> 1 & 1, corner & 1), voxel = cell + offset;
        if (reader.leaf(voxel) != nullptr) return {Region::Kind::cells, 0, cell, cell.offsetBy(1)};
        const int dim = reader.edge(voxel);
        const Coord first = (voxel & ~(dim - 1)) - offset;
        region.low.maxComponent(first);
        region.high.minComponent(first.offsetBy(dim));
        if (reader.value(voxel) != region.value) region.kind = Region::Kind::cells;
    }
    return region;
}

/// `map` may be null.
Region region_at(const CellReader& reader, const BlockMap* map, const Coord& cell) {
    Region region;
    const BlockMap::Kind kind = map != nullptr ? map->kind(cell) : BlockMap::Kind::edge;
    if (kind == BlockMap::Kind::empty) {
        region.kind = Region::Kind::constant;
        map->find_empty(cell, region.low, region.high);
        return region;
    }
    if (kind == BlockMap::Kind::voxels || (map == nullptr && reader.leaf(cell) != nullptr)) {
        region.kind = Region::Kind::leaf;
        region.low = cell & ~(CellReader::k_edge - 1);
        region.high = region.low.offsetBy(CellReader::k_edge);
        return region;
    }
    const int dim = reader.edge(cell);
    region.low = cell & ~(dim - 1);
    region.high = region.low.offsetBy(dim - 1);
    if (cell[0] == region.high[0] || cell[1] == region.high[1] || cell[2] == region.high[2])
        return between_tiles(reader, cell);
    region.kind = Region::Kind::constant;
    region.value = reader.value(cell);
    return region;
}

void append(std::vector<GridStretch>& intervals, std::size_t first, const GridStretch& next) {
    if (!(next.end > next.begin)) return;
    if (intervals.size() > first && intervals.back().end == next.begin &&
        intervals.back().constant == next.constant && !next.constant)
        intervals.back().end = next.end;
    else
        intervals.push_back(next);
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
    const Grid& typed = *static_cast<const Grid*>(grid_);
    if (RootBlocks::are_many(typed)) roots_ = std::make_shared<const RootBlocks>(typed);
    map_ = BlockMap::of(typed, support_);
}

double NanoGrid::sample(const Point3& p) const {
    return Sampler(grid_, roots_.get(), support_)(p);
}

void NanoGrid::add_samples(const LatticeLine& line, std::span<const double> t,
                           std::span<double> values) const {
    Sampler sampler(grid_, roots_.get(), support_);
    for (std::size_t n = 0; n < t.size(); ++n)
        values[n] += sampler(line.origin + t[n] * line.direction);
}

double NanoGrid::integrate(const LatticeLine& line) const {
    CellReader reader(grid_, roots_.get());
    LineIntegral line_integral(line);
    double integral = 0;
    LatticeWalk walk(line, 0, 1, support_);
    while (!walk.done()) {
        const Coord cell = walk.cell();
        const double begin = walk.t();
        const BlockMap::Kind kind = map_ ? map_->kind(cell) : BlockMap::Kind::voxels;
        const bool is_edge = kind == BlockMap::Kind::edge;
        if ((is_edge || kind == BlockMap::Kind::voxels) && (reader.enter(cell) || is_edge)) {
            const double end = walk.leave(reader.low(), reader.low().offsetBy(CellReader::k_edge));
            if (end > begin) integral += line_integral.over_block(reader, begin, end);
            continue;
        }
        const Region region = region_at(reader, map_.get(), cell);
        const double end = walk.leave(region.low, region.high);
        if (region.kind == Region::Kind::constant) {
            integral += static_cast<double>(region.value) * (end - begin);
        } else if (end > begin) {
            integral += line_integral.over_cell(reader.corners(cell), cell, begin, end);
        }
    }
    return integral;
}

std::size_t NanoGrid::regions_along(const LatticeLine& line) const {
    const CellReader reader(grid_, roots_.get());
    std::size_t count = 0;
    for (LatticeWalk walk(line, 0, 1, support_); !walk.done(); ++count) {
        const Region region = region_at(reader, map_.get(), walk.cell());
        walk.leave(region.low, region.high);
    }
    return count;
}

void NanoGrid::append_intervals(const LatticeLine& line, double begin, double end,
                                std::vector<GridStretch>& intervals) const {
    CellReader reader(grid_, roots_.get());
    const std::size_t first = intervals.size();
    LatticeWalk walk(line, begin, end, support_);
    while (!walk.done()) {
        const Coord cell = walk.cell();
        const Region region = region_at(reader, map_.get(), cell);
        const bool constant = region.kind == Region::Kind::constant;
        const bool empty = (constant && region.value == 0) ||
                           (region.kind == Region::Kind::cells && reader.corners(cell).zero());
        const double from = walk.t();
        const double to = walk.leave(region.low, region.high);
        if (!empty) append(intervals, first, {from, to, constant});
    }
}

double NanoGrid::stored_sum() const {
    const auto& tree = static_cast<const Grid*>(grid_)->tree();
    const auto* blocks = tree.getFirstLeaf();
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

namespace {

// Whether a voxel's volume is negligible compared with its edges: sums along rays through it are
// not reliable.
bool is_flat(const Matrix3& edges) {
    constexpr double k_flattest = 1e-6;
    const double longest =
        std::max({glm::length(edges[0]), glm::length(edges[1]), glm::length(edges[2])});
    const double volume = std::abs(glm::determinant(edges / longest));
    return !(std::isfinite(longest) && volume > k_flattest);
}

}  // namespace

void check_loaded(const VdbHeader& header, const GridSummary& grid, const std::string& prefix,
                  const LoadedGrid& loaded) {
    const bool classless = grid.grid_class != "fog volume";
    const std::int64_t negative = loaded.statistics.negative_voxels;
    if (classless && loaded.statistics.background > 0 && negative > 0)
        throw InputError(fmt::format(
            "{}is a level set, though its class is '{}' (background {:g}, {} negative voxels), not "
            "a concentration; give its volume level_set: fog, which fills its inside, or write "
            "{{file, grid}} under geometry, which shows its surface; the file has {}",
            prefix, grid.grid_class, loaded.statistics.background, negative,
            header.describe_grids()));
    if (is_flat(loaded.file_from_index.linear()))
        throw InputError(prefix + "its transform is singular (voxels without volume)");
}

Placement decide_placement(const VdbHeader& header, const VolumeDesc& desc) {
    const bool blender = header.from_blender_fluid();
    Placement placement{desc.centering, desc.up, desc.centering == Centering::automatic,
                        desc.up == UpAxis::automatic};
    if (placement.automatic_centering)
        placement.centering = blender ? Centering::cell : Centering::node;
    if (placement.automatic_up)
        placement.up = blender || header.from_embergen() ? UpAxis::z : UpAxis::y;
    return placement;
}

const char* name_of_up(UpAxis up) {
    return up == UpAxis::x ? "x" : up == UpAxis::z ? "z" : "y";
}

Affine upright_from_file(UpAxis up) {
    // Column by column: x stays, the file's y becomes -z, its z becomes y.
    const Affine upright_from_z_up(Matrix3(1, 0, 0, 0, 0, -1, 0, 1, 0), Vector3(0.0));
    // The file's x becomes y, its y becomes z, its z becomes x.
    const Affine upright_from_x_up(Matrix3(0, 1, 0, 0, 0, 1, 1, 0, 0), Vector3(0.0));
    return up == UpAxis::z ? upright_from_z_up : up == UpAxis::x ? upright_from_x_up : Affine();
}

Affine world_from_index(const LoadedGrid& grid, const Placement& placement,
                        const Affine& world_from_upright) {
    return world_from_upright * upright_from_file(placement.up) * grid.file_from_index;
}

}  // namespace uw
