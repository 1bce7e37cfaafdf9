#pragma once

#include <span>
#include <vector>

#include "core/base/ray.h"
#include "core/optics/depth_tolerance.h"

namespace uw {

/// Concentrations along a ray for the integrators: values at ascending knots, linear in between,
/// and their cumulative integrals (columns).
struct ConcentrationProfile {
    int constituent_count = 0;
    std::vector<double> s;              // knot positions [m]; first 0, last the requested end
    std::vector<double> concentration;  // [knot * constituent_count + k], in the constituent's unit
    std::vector<double> column;         // int_0^s, same layout [unit m]

    bool empty_between(std::size_t knot) const {  // zero between knot and knot + 1
        for (int k = 0; k < constituent_count; ++k) {
            const std::size_t i =
                knot * static_cast<std::size_t>(constituent_count) + static_cast<std::size_t>(k);
            if (concentration[i] != 0 ||
                concentration[i + static_cast<std::size_t>(constituent_count)] != 0)
                return false;
        }
        return true;
    }
    /// Computes the columns, those of linear concentrations between the knots.
    void integrate();
};

/// Spatially varying concentrations of the medium's constituents, on top of the uniform water.
/// Thread safe.
class ConcentrationField {
  public:
    virtual ~ConcentrationField() = default;

    virtual int constituent_count() const = 0;
    /// World bounds outside which every concentration is zero; empty if all are zero everywhere.
    virtual Bounds bounds() const = 0;
    /// Edge of the finest voxel [m]; 0 without voxels.
    virtual double finest_voxel() const = 0;

    /// Concentrations at `x` (world), one per constituent.
    virtual void sample(const Point3& x, std::span<double> concentration) const = 0;

    /// The exact integrals of the interpolated concentrations from `a` to `b` [unit m].
    virtual void column(const Point3& a, const Point3& b, std::span<double> column) const = 0;

    /// Concentrations along `ray` from 0 to `s_end`, with knots at the resolution of the voxels;
    /// `profile` is reused storage and is overwritten. Intervals without particles take two knots.
    virtual void profile(const Ray& ray, double s_end, ConcentrationProfile& profile) const = 0;

    /// The same with as few knots as `tolerance` allows.
    virtual void profile_within(const DepthTolerance& /*tolerance*/, const Ray& ray, double s_end,
                                ConcentrationProfile& profile) const {
        this->profile(ray, s_end, profile);
    }
};

}  // namespace uw
