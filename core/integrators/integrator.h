#pragma once

#include <span>
#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/integrators/surface_light.h"

namespace uw {

/// In-scattered radiance [W m^-2 sr^-1] up to several distances along one ray.
class InScatter {
  public:
    void reset(std::size_t ends, std::size_t lamps) {
        lamps_ = lamps;
        values_.assign(ends * lamps, Spectrum{});
    }
    std::size_t lamp_count() const { return lamps_; }
    Spectrum& at(std::size_t end, std::size_t lamp) { return values_[end * lamps_ + lamp]; }
    const Spectrum& at(std::size_t end, std::size_t lamp) const {
        return values_[end * lamps_ + lamp];
    }

  private:
    std::size_t lamps_ = 0;
    std::vector<Spectrum> values_;
};

/// Single scattering along camera rays (physics section 5). Thread safe.
class Integrator {
  public:
    virtual ~Integrator() = default;

    /// In-scattered radiance from the ray's origin to each of `ends` [m, ascending; the last may
    /// be k_far for a ray that meets nothing], for each lamp.
    virtual void in_scatter(const Ray& ray, std::span<const double> ends,
                            InScatter& result) const = 0;

    /// Likewise from `begin` [m] on, which lies before all of `ends`. What is here takes the
    /// difference of two in_scatter; integrators that can leave out what lies before do.
    virtual void in_scatter_from(const Ray& ray, double begin, std::span<const double> ends,
                                 InScatter& result) const;

    /// Light on surface points; faster for many at once that are seen side by side.
    virtual void surface_lights(std::span<const SurfaceSample* const> samples,
                                SurfaceLight& light) const = 0;
    /// Light on one.
    void surface_light(const SurfaceSample& sample, SurfaceLight& light) const {
        const SurfaceSample* const one = &sample;
        surface_lights(std::span(&one, 1), light);
    }
};

/// Stands for "no surface": no lamp's light returns from farther [m].
inline constexpr double k_far = 1e4;

}  // namespace uw
