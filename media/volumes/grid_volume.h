#pragma once

#include <vector>

#include "core/optics/grid_load.h"
#include "media/vdb/nano_grid.h"
#include "media/vdb/placement.h"

namespace uw {

/// One grid in the world: its values, their placement and their meaning.
class GridVolume {
  public:
    GridVolume(std::vector<NanoGrid> bricks, const Affine& world_from_index, Centering centering,
               std::vector<GridLoad> loads);

    /// The same grid, its values shared, with `factor` times the concentrations.
    GridVolume scaled(double factor) const;

    const std::vector<NanoGrid>& bricks() const { return bricks_; }
    const std::vector<GridLoad>& loads() const { return loads_; }
    /// World bounding box outside which the interpolated value is zero; empty for a grid without
    /// values.
    const Bounds& bounds() const { return bounds_; }
    /// World bounding box of the nonzero voxels, each a cell around its value's position.
    const Bounds& voxel_bounds() const { return voxel_bounds_; }
    /// Lengths of a voxel's edges along index i, j, k [m].
    const Vector3& voxel_size() const { return voxel_size_; }

    /// The line `origin + t * direction` (world, t in the caller's unit) in lattice space.
    LatticeLine lattice_line(const Point3& origin, const Vector3& direction) const {
        return {lattice_from_world_ * origin, lattice_from_world_.apply_to_vector(direction)};
    }
    /// The interpolated value at `x` (world).
    double value(const Point3& x) const;
    /// The exact integral of the interpolated value from `a` to `b` (world) [value m].
    double column(const Point3& a, const Point3& b) const;

  private:
    std::vector<NanoGrid> bricks_;
    std::vector<GridLoad> loads_;
    Affine lattice_from_world_;
    Bounds bounds_, voxel_bounds_;
    Vector3 voxel_size_{0};
};

}  // namespace uw
