#pragma once

#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/geometry/glass.h"
#include "core/light/integrator.h"
#include "core/light/medium.h"

namespace uw {

/// A straight part of what is seen through glass: it begins at a surface of glass, or where the
/// water's surface mirrors it, and ends at the next surface.
struct GlassLeg {
    Ray ray;
    bool is_in_water = true;  ///< else in glass, or in the air that it encloses
    bool has_hit = false;
    SurfaceHit hit;  ///< the surface at its end
    Spectrum
        weight{};      ///< fraction of the light that arrives at its beginning that the camera gets
    Spectrum clear{};  ///< the same without water
    Spectrum left{};   ///< fraction of light that is left of what its end sends to its beginning
};

/// Follows what a camera ray sees where it meets glass: a tree of refracted and reflected rays.
/// A branch ends when less than k_min_weight of its light arrives, or after k_max_depth surfaces.
/// Thread safe.
class GlassView {
  public:
    static constexpr double k_min_weight = 1e-4;
    static constexpr int k_max_depth = 32;

    /// References must outlive this object. Precondition: the scene has glass.
    explicit GlassView(const LitScene& scene);

    /// Sets `legs` to all legs behind `hit`, the glass that the camera ray `ray` meets first.
    void follow(const Ray& ray, const SurfaceHit& hit, std::vector<GlassLeg>& legs) const;

  private:
    LitScene scene_;
    AttenuationTable attenuation_;
    std::size_t bands_;
};

}  // namespace uw
