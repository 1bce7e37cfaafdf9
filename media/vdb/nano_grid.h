#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "media/vdb/cells/lattice_line.h"

namespace uw {

/// An interval of a line within which a grid may be non-zero.
struct GridStretch {
    double begin = 0, end = 0;  // line parameter
    bool constant = false;      // one value throughout
};

/// One sparse grid of 16-bit quantised values (NanoVDB, Fp16: within a block of 8^3 voxels the
/// error is at most 1/131070 of the block's range), interpolated trilinearly, zero outside. Works
/// in lattice space, where the value of voxel (i, j, k) sits at (i, j, k). Thread safe.
class NanoGrid {
  public:
    /// `grid` points to the NanoVDB grid inside the memory owned by `storage` (see
    /// media/vdb/vdb_file.cpp). `min` and `max` (inclusive) bound its nonzero voxels, |coordinates|
    /// < 2^30.
    NanoGrid(std::shared_ptr<const void> storage, const void* grid, std::size_t bytes,
             const std::array<int, 3>& min, const std::array<int, 3>& max);

    /// Bounding box in lattice space outside which the interpolated value is zero.
    const Bounds& support() const { return support_; }
    std::size_t bytes() const { return bytes_; }
    /// The grid itself, of so many bytes; with the support, what another NanoGrid is made of.
    const void* data() const { return grid_; }

    double sample(const Point3& p) const;
    /// Adds the value at p(t[n]) to values[n]. `t` must be ascending.
    void add_samples(const LatticeLine& line, std::span<const double> t,
                     std::span<double> values) const;
    /// The exact integral of the interpolated value over t in [0, 1], in units of t.
    double integrate(const LatticeLine& line) const;
    /// Appends the intervals of [begin, end] outside which the value is exactly zero; ascending,
    /// disjoint, with adjacent ones of the same kind merged.
    void append_stretches(const LatticeLine& line, double begin, double end,
                          std::vector<GridStretch>& stretches) const;
    /// The sum of all values except those of constant regions (tiles): the minimal work that
    /// touches every voxel in memory, on all permitted threads.
    double stored_sum() const;

  private:
    std::shared_ptr<const void> storage_;
    const void* grid_;
    std::size_t bytes_;
    Bounds support_;
};

}  // namespace uw
