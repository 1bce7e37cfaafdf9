#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/light/medium.h"
#include "media/volumes/grid_field.h"

namespace uw {

/// Accumulates the derivatives by the values of one grid, in the box of indices from 0 to `size`;
/// values outside are ignored.
class VoxelGradient final : public FieldGradient {
  public:
    /// `grid` must outlive it.
    VoxelGradient(const GridVolume& grid, const std::array<std::size_t, 3>& size);

    void add_sample(const Point3& x, std::span<const double> weights) override;
    /// The interpolant is a cubic along a line through a cell, whose integral two nodes have
    /// exactly (Gauss).
    void add_column(const Point3& a, const Point3& b, std::span<const double> weights) override;

    /// By value (i, j, k): [(i * size[1] + j) * size[2] + k].
    std::span<const double> values() const { return values_; }

  private:
    // The weight of the grid's value.
    double of_value(std::span<const double> weights) const;
    void add(const Point3& lattice, double weight);

    const GridVolume& grid_;
    std::array<std::size_t, 3> size_;
    std::vector<double> values_;
};

}  // namespace uw
