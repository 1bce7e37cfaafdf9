#pragma once

#include <span>
#include <vector>

#include "core/bands.h"
#include "core/ray.h"
#include "core/surfaces.h"

namespace uw {

/// Light that falls on one surface point from one lamp, and how it would be without water.
struct LampIrradiance {
    bool visible = false;
    Spectrum irradiance{};  // W/m^2, attenuated by the water on its way, 0 if shadowed
    Spectrum clean{};       // W/m^2, without water
};

/// What a camera ray sees of a surface point.
struct SurfaceLight {
    std::vector<LampIrradiance> lamps;  // one per lamp
    Spectrum transmittance{};           // e^-tau from the surface to the ray's origin
};

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

    /// Light on the surface point that `ray` meets.
    virtual void surface_light(const Ray& ray, const SurfaceHit& hit,
                               SurfaceLight& light) const = 0;
};

/// Stands for "no surface": no lamp's light returns from farther [m].
inline constexpr double k_far = 1e4;

}  // namespace uw
