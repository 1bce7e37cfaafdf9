#pragma once

#include <memory>
#include <vector>

#include "core/light/medium.h"
#include "media/volumes/grid_field.h"

namespace uw {

/// Grids in water that varies with depth: the sum of both.
class StratifiedField final : public ConcentrationField {
  public:
    StratifiedField(std::shared_ptr<const ConcentrationField> grids,
                    std::shared_ptr<const Strata> strata);

    std::shared_ptr<const Strata> strata() const override { return strata_; }
    const ConcentrationField& grids() const override { return *grids_; }
    int constituent_count() const override { return grids_->constituent_count(); }
    /// All of the world in which scenes may lie.
    Bounds bounds() const override;
    double finest_voxel() const override { return grids_->finest_voxel(); }
    void sample(const Point3& x, std::span<double> concentration) const override;
    void column(const Point3& a, const Point3& b, std::span<double> column) const override;
    /// The profile has the grids' knots, and those at which the strata bend. Columns are those of
    /// both.
    void profile(const Ray& ray, double s_end, ConcentrationProfile& profile) const override;
    void coarse_profile(const Ray& ray, double s_end, ConcentrationProfile& profile) const override;
    void profile_within(const DepthTolerance& tolerance, const Ray& ray, double s_end,
                        ConcentrationProfile& profile) const override;

  private:
    void add_strata(const Ray& ray, double s_end, ConcentrationProfile& profile) const;

    std::shared_ptr<const ConcentrationField> grids_;
    std::shared_ptr<const Strata> strata_;
};

/// A field of grids, in water whose strata may be null.
std::shared_ptr<const ConcentrationField> make_field(std::vector<GridVolume> grids,
                                                     int constituent_count,
                                                     std::shared_ptr<const Strata> strata);

}  // namespace uw
