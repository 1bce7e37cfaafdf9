#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/base/spectrum.h"
#include "core/base/vector_math.h"
#include "core/light/integrator_kind.h"
#include "core/paths/half_tangent_density.h"
#include "render/assembled_scene.h"

namespace uw {

/// An estimate per band and its standard error.
struct MeteredSpectrum {
    Spectrum mean{}, error{};
};

/// What meters at one point in the water tell (Mobley 1994, "Light and Water", chapter 1). Plane
/// irradiance falls on one side of a level plane; scalar irradiance comes from one half of all
/// directions and counts the same whatever its slope [W/m^2]. Radiance travels straight up or down
/// [W m^-2 sr^-1], without that of lamps and suns themselves.
struct MeterReading {
    MeteredSpectrum down, up;                // plane: E_d, E_u
    MeteredSpectrum scalar_down, scalar_up;  // E_od, E_ou
    MeteredSpectrum radiance_down, radiance_up;
};

/// What a radiometer above calm water tells of the water below (Mobley 1999, "Estimation of the
/// remote-sensing reflectance from above-surface measurements", Applied Optics 38, 7442). Light
/// that the surface reflects is left out.
struct WaterLeaving {
    Spectrum irradiance{};        // E_d in the air: all of suns and sky [W/m^2]
    MeteredSpectrum radiance;     // L_w, straight up, in the air [W m^-2 sr^-1]
    MeteredSpectrum reflectance;  // R_rs = L_w / E_d [1/sr]; 0 in bands without irradiance
};

/// Reads all light at points of a scene, by light paths: that of lamps, suns and sky directly by
/// their directions, the rest by rays drawn evenly in all directions and towards lamps. Thread
/// safe.
class LightMeter {
  public:
    /// `scene` must outlive this object.
    explicit LightMeter(const AssembledScene& scene);

    /// At `x`, where `up` (unit) is up: `rays` rays, at least 16, in 16 batches, whose spread is
    /// the standard error. Runs on all threads. The same point and number give the same numbers.
    MeterReading read(const Point3& x, const Vector3& up, int rays) const;

    /// At the water's surface above or below `x`, by `rays` rays, straight down from just below it:
    /// L_w = (1 - R) L_u / n^2, with Fresnel's reflectance R (Mobley 1999, equation 4, where waves
    /// are calm). None if the surface has no index or has waves, or if no sun or sky lights it.
    std::optional<WaterLeaving> read_water_leaving(const Point3& x, int rays) const;

  private:
    const AssembledScene& scene_;
    LightTransport transport_;
    HalfTangentDensity around_lamps_;  // of rays, over the angle to each lamp
};

}  // namespace uw
