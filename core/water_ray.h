#pragma once

#include <optional>

#include "core/affine.h"
#include "core/ray.h"

namespace uw {

/// Where camera rays come from: pixel in, ray in the water out. Thread safe.
class RaySource {
  public:
    virtual ~RaySource() = default;

    virtual int width() const = 0;
    virtual int height() const = 0;

    /// The ray in water (world space) that the camera sees at image position (x, y) in pixels;
    /// the image's corner is (0, 0), the first pixel's centre (0.5, 0.5). Its origin lies on the
    /// outer glass surface, or at the camera centre without a port. Empty where no ray enters the
    /// water: the port is missed or reflects totally.
    virtual std::optional<Ray> water_ray(double x, double y) const = 0;

    virtual const Affine& world_from_camera() const = 0;
};

}  // namespace uw
