#pragma once

#include <span>
#include <vector>

#include "core/optics/concentration_field.h"
#include "media/volumes/grid_volume.h"

namespace uw {

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
    /// Knots every voxel where the tolerance permits, and closer where it does not, down to those
    /// of profile().
    void profile_within(const DepthTolerance& tolerance, const Ray& ray, double s_end,
                        ConcentrationProfile& profile) const override;

  private:
    // The concentrations at the distances `s`.
    void sample_knots(const Ray& ray, std::span<const double> s,
                      std::vector<double>& concentration) const;

    std::vector<GridVolume> volumes_;
    int constituent_count_;
    Bounds bounds_;
    double finest_voxel_ = 0;
};

}  // namespace uw
