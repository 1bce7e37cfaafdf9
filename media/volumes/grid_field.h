#pragma once

#include <span>
#include <vector>

#include "core/light/medium.h"
#include "media/volumes/loaded_grid.h"

namespace uw {

/// One grid in the world: its values, their placement and their meaning.
class GridVolume {
  public:
    GridVolume(std::vector<NanoGrid> bricks, const Affine& world_from_index, Centering centering,
               std::vector<GridLoad> loads);

    /// This grid with `factor` times the concentrations; both share the values.
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
    Point3 lattice_point(const Point3& x) const { return lattice_from_world_ * x; }
    /// The interpolated value at `x` (world).
    double value(const Point3& x) const;
    /// The exact integral of the interpolated value from `a` to `b` (world) [value m].
    double column(const Point3& a, const Point3& b) const;
    /// The cost of that integral: NanoGrid::regions_along.
    std::size_t regions_along(const Point3& a, const Point3& b) const;

  private:
    std::vector<NanoGrid> bricks_;
    std::vector<GridLoad> loads_;
    Affine lattice_from_world_;
    Bounds bounds_, voxel_bounds_;
    Vector3 voxel_size_{0};
};

/// Concentrations from any number of grids; overlapping ones add up. sample() is the exact
/// trilinear sum, column() its exact integral; profile() has knots every quarter voxel of the
/// finest grid active there, and its columns are the integrals of the linear segments between them.
class GridField final : public ConcentrationField {
  public:
    GridField(std::vector<GridVolume> volumes, int constituent_count);

    const std::vector<GridVolume>& volumes() const { return volumes_; }
    int constituent_count() const override { return constituent_count_; }
    Bounds bounds() const override { return bounds_; }
    double finest_voxel() const override { return finest_voxel_; }
    void sample(const Point3& x, std::span<double> concentration) const override;
    void column(const Point3& a, const Point3& b, std::span<double> column) const override;
    void profile(const Ray& ray, double s_end, ConcentrationProfile& profile) const override;
    void coarse_profile(const Ray& ray, double s_end, ConcentrationProfile& profile) const override;
    /// Knots every voxel where the tolerance permits, and closer where it does not, down to those
    /// of profile().
    void profile_within(const DepthTolerance& tolerance, const Ray& ray, double s_end,
                        ConcentrationProfile& profile) const override;

  private:
    // With knots `steps` times as far apart as those of profile(). Whether there are any particles.
    // `least`, by interval between knots: the step of its piece, infinite where nothing varies.
    bool sample_profile(const Ray& ray, double s_end, double steps, ConcentrationProfile& profile,
                        std::vector<double>& least) const;
    // The concentrations at the distances `s`.
    void sample_knots(const Ray& ray, std::span<const double> s,
                      std::vector<double>& concentration) const;

    std::vector<GridVolume> volumes_;
    int constituent_count_;
    Bounds bounds_;
    double finest_voxel_ = 0;
};

}  // namespace uw
