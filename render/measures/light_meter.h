#pragma once

#include <cstdint>
#include <memory>

#include "core/base/spectrum.h"
#include "core/base/vector_math.h"
#include "core/light/integrator_kind.h"
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

  private:
    const AssembledScene& scene_;
    LightTransport transport_;
};

}  // namespace uw
