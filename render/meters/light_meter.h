#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/base/spectrum.h"
#include "core/base/vector_math.h"
#include "core/light/half_tangent_density.h"
#include "core/light/integrator_kind.h"
#include "render/assembled_scene.h"

namespace uw {

/// An estimate per band and its standard error.
struct MeteredSpectrum {
    Spectrum mean{}, error{};
};

/// The light at one point in the water (Mobley 1994, "Light and Water", chapter 1). Plane
/// irradiance falls on one side of a level plane; scalar irradiance is that from one half of all
/// directions, not weighted by the cosine [W/m^2]. Radiance travels straight up or down [W m^-2
/// sr^-1], without that of lamps and suns themselves.
struct MeterReading {
    MeteredSpectrum down, up;                // plane: E_d, E_u
    MeteredSpectrum scalar_down, scalar_up;  // E_od, E_ou
    MeteredSpectrum radiance_down, radiance_up;
};

/// The light that leaves calm water upwards (Mobley 1999, "Estimation of the remote-sensing
/// reflectance from above-surface measurements", Applied Optics 38, 7442), without light that the
/// surface reflects.
struct WaterLeaving {
    Spectrum irradiance{};        // E_d in the air, of suns and sky [W/m^2]
    MeteredSpectrum radiance;     // L_w, straight up, in the air [W m^-2 sr^-1]
    MeteredSpectrum reflectance;  // R_rs = L_w / E_d [1/sr]; 0 in bands without irradiance
};

/// Estimates all light at points of a scene by path tracing. Direct light of lamps, suns and sky is
/// computed in closed form; the rest is estimated by rays, whose directions are sampled uniformly
/// and around lamps. Thread safe.
class LightMeter {
  public:
    /// `scene` must outlive this object.
    explicit LightMeter(const AssembledScene& scene);

    /// Reads the light at `x` with `rays` >= 16 rays; `up` (unit) points upwards. The standard
    /// error follows from the spread of 16 batches. Runs on all threads. The same point and number
    /// of rays give the same result.
    MeterReading read(const Point3& x, const Vector3& up, int rays) const;

    /// Reads the light at the water's surface above or below `x`, with `rays` rays straight down
    /// from just below it: L_w = (1 - R) L_u / n^2, with the Fresnel reflectance R (Mobley 1999,
    /// equation 4, without waves). None if the surface has no index or has waves, or if neither sun
    /// nor sky lights it.
    std::optional<WaterLeaving> read_water_leaving(const Point3& x, int rays) const;

  private:
    const AssembledScene& scene_;
    LightTransport transport_;
    HalfTangentDensity around_lamps_;  // pdf of rays over the angle to each lamp
};

}  // namespace uw
