#pragma once

#include <optional>

#include "core/base/affine.h"
#include "core/base/ray.h"

namespace uw {

/// How light arrives at the lens.
struct LensRay {
    /// The irradiance behind the lens relative to that on its axis, for equal radiance: cos^4 of
    /// the angle to the optical axis, inside the housing, for a rectilinear lens.
    double falloff = 1;
    /// The port's factor on the radiance in water; 1 unless the scene requests it.
    double port_transmittance = 1;
};

/// Generates camera rays: from a pixel to its ray in the water. Thread safe.
class RaySource {
  public:
    virtual ~RaySource() = default;

    virtual int width() const = 0;
    virtual int height() const = 0;

    /// The ray in water (world space) that the camera sees at image position (x, y) in pixels; the
    /// image's corner is (0, 0), the first pixel's centre (0.5, 0.5). Its origin lies on the outer
    /// glass surface, or at the camera centre without a port. Empty if no ray enters the water: it
    /// misses the port or is totally reflected.
    virtual std::optional<Ray> refracted_ray(double x, double y) const = 0;

    /// How the light of the water ray at image position (x, y) arrives at the lens.
    /// Precondition: there is a water ray.
    virtual LensRay lens_ray(double x, double y) const = 0;
    /// Whether some lens ray's port_transmittance is not 1.
    virtual bool port_dims() const = 0;

    virtual const Affine& world_from_camera() const = 0;
};

}  // namespace uw
