#pragma once

#include "core/light/medium.h"

namespace uw::test {

/// A Gaussian cloud of one constituent, nu = peak exp(-r^2 / 2 sigma^2), with closed-form columns:
/// the truth against which grids and deep shadow maps are measured. Zero beyond 6 sigma (1.5e-8).
class GaussianField : public ConcentrationField {
  public:
    /// `pace`: the voxel size that it reports, and twice the spacing of its profiles' knots [m].
    GaussianField(const Point3& center, double sigma, double peak, double pace);

    int constituent_count() const override { return 1; }
    Bounds bounds() const override;
    double finest_voxel() const override { return pace_; }
    void sample(const Point3& x, std::span<double> concentration) const override;
    void column(const Point3& a, const Point3& b, std::span<double> column) const override;
    void profile(const Ray& ray, double s_end, ConcentrationProfile& profile) const override;

  private:
    Point3 center_;
    double sigma_, peak_, pace_;
};

}  // namespace uw::test
