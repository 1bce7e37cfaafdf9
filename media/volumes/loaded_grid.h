#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/vector_math.h"
#include "core/scene/volume_desc.h"
#include "media/volumes/lattice_cell.h"
#include "media/volumes/vdb_header.h"

namespace uw {

/// Statistics of a grid's active voxels (tiles count with all their voxels). By OpenVDB's
/// convention inactive voxels are not data, whatever value a writer left in them.
struct GridStatistics {
    std::int64_t active_voxels = 0;
    std::int64_t nan_voxels = 0, infinite_voxels = 0, negative_voxels = 0;  // treated as 0
    double background = 0;                                                  // treated as 0
    double min = 0, mean = 0, max = 0;  // over active voxels, with invalid values set to 0
};

/// Takes voxel values one by one, sanitises each and updates the counts.
struct GridIntake {
    std::int64_t active = 0, nan = 0, infinite = 0, negative = 0;
    double sum = 0;
    float min = std::numeric_limits<float>::infinity(), max = -min;

    /// The sanitised `value`, counted for `voxels` voxels.
    float take(float value, std::int64_t voxels) {
        active += voxels;
        if (!std::isfinite(value)) {
            (std::isnan(value) ? nan : infinite) += voxels;
            value = 0;
        } else if (value < 0) {
            negative += voxels;
            value = 0;
        }
        sum += static_cast<double>(value) * static_cast<double>(voxels);
        min = std::min(min, value);
        max = std::max(max, value);
        return value;
    }
    /// Adds the counts of another part of the grid.
    void add(const GridIntake& other) {
        active += other.active;
        nan += other.nan;
        infinite += other.infinite;
        negative += other.negative;
        sum += other.sum;
        min = std::min(min, other.min);
        max = std::max(max, other.max);
    }
    GridStatistics statistics(double background) const;
};

/// Warnings about a grid's values, one line each, all beginning with `prefix`.
std::vector<std::string> intake_warnings(const GridStatistics& statistics,
                                         const std::string& prefix);

/// An interval of a line within which a grid may be non-zero.
struct GridStretch {
    double begin = 0, end = 0;  // line parameter
    bool constant = false;      // one value throughout
};

class BlockMap;
class RootBlocks;

/// One sparse grid of 16-bit quantised values (NanoVDB, Fp16: within a block of 8^3 voxels the
/// error is at most 1/131070 of the block's range), interpolated trilinearly, zero outside. Works
/// in lattice space, where the value of voxel (i, j, k) sits at (i, j, k). Thread safe.
class NanoGrid {
  public:
    /// `grid` points to the NanoVDB grid inside the memory owned by `storage` (see
    /// media/volumes/vdb_file.cpp). `min` and `max` (inclusive) bound its nonzero voxels,
    /// |coordinates| < 2^30.
    NanoGrid(std::shared_ptr<const void> storage, const void* grid, std::size_t bytes,
             const std::array<int, 3>& min, const std::array<int, 3>& max);

    /// Bounding box in lattice space outside which the interpolated value is zero.
    const Bounds& support() const { return support_; }
    std::size_t bytes() const { return bytes_; }
    /// The bytes of the grid itself, from which, with the support, another NanoGrid can be made.
    const void* data() const { return grid_; }

    double sample(const Point3& p) const;
    /// Adds the value at p(t[n]) to values[n]. `t` must be ascending.
    void add_samples(const LatticeLine& line, std::span<const double> t,
                     std::span<double> values) const;
    /// The exact integral of the interpolated value over t in [0, 1], in units of t.
    double integrate(const LatticeLine& line) const;
    /// The number of regions that the line meets at t in [0, 1], to which the cost of integrate()
    /// is proportional: blocks of 8^3 voxels, larger ones of one value, and layers of cells between
    /// these.
    std::size_t regions_along(const LatticeLine& line) const;
    /// Appends the intervals of [begin, end] outside which the value is exactly zero; ascending,
    /// disjoint, with adjacent ones of the same kind merged.
    void append_intervals(const LatticeLine& line, double begin, double end,
                          std::vector<GridStretch>& intervals) const;
    /// The sum of all values except those of constant regions (tiles): the minimal work that
    /// touches every voxel in memory, on all permitted threads.
    double stored_sum() const;

  private:
    std::shared_ptr<const void> storage_;
    const void* grid_;
    std::shared_ptr<const RootBlocks> roots_;  // null for a few
    std::shared_ptr<const BlockMap> map_;      // null for a box of mostly nothing
    std::size_t bytes_;
    Bounds support_;
};

/// A grid ready to be sampled. Large grids are split into several bricks whose values add up: each
/// contains a slab of whole 8^3 blocks, and interpolation with zeros outside is linear.
struct LoadedGrid {
    std::string name;
    Affine file_from_index;  // the file's transform: metres, index (i, j, k) where OpenVDB puts it
    std::vector<NanoGrid> bricks;       // none if every value is zero
    std::array<std::size_t, 3> size{};  // of an array, whose first value has the index 0, 0, 0
    GridStatistics statistics;
    std::vector<std::string> warnings;  // one line each, starting with `where`
};

/// Throws InputError starting with `prefix` if the loaded grid is an undeclared level set, or if
/// its voxels have no volume.
void check_loaded(const VdbHeader& header, const GridSummary& grid, const std::string& prefix,
                  const LoadedGrid& loaded);

/// How a file's grids are placed, with `automatic` resolved.
struct Placement {
    Centering centering = Centering::node;  // cell: value (i, j, k) sits at index i + 1/2; node: i
    UpAxis up = UpAxis::y;  // z: the file's (x, y, z) is the scene's (x, z, -y); x: (z, x, y)
    bool automatic_centering = false, automatic_up = false;  // decided from the file, not the scene
};

/// Automatic means cell and z for caches of Blender's fluid solver, node and z for what EmberGen
/// exports, node and y for all others.
Placement decide_placement(const VdbHeader& header, const VolumeDesc& desc);

/// How scenes call an axis: "x", "y" or "z".
const char* name_of_up(UpAxis up);

/// Rotates the file's up axis to y.
Affine upright_from_file(UpAxis up);

/// World from the file's index space: transform * up * the file's own transform.
Affine world_from_index(const LoadedGrid& grid, const Placement& placement,
                        const Affine& world_from_upright);

}  // namespace uw
