#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/base/ray_source.h"
#include "core/base/spectrum.h"
#include "core/integrators/sensor.h"
#include "core/scene/scene_desc.h"

namespace uw {

/// How many photoelectrons light sets free in the pixels of a scene's sensor
/// (docs/camera-image.md): eta E A t lambda / (h c), summed over the bands, with E the irradiance
/// behind the lens.
class Photoelectrons {
  public:
    /// Of the camera of a scene that complete_sensors has checked. Throws InputError for a table of
    /// efficiencies that is not valid or in which a colour sees none of the bands; IoError if it
    /// cannot be read.
    explicit Photoelectrons(const SceneDesc& scene);

    /// Irradiance on the sensor per radiance in water [sr], for the pixel that `lens_ray` belongs
    /// to: the lens's factor (SensorModel) and, behind a port, (n_air / n_water)^2 unless the
    /// image's radiance is in air already. The port's transmittance is in the radiance.
    /// `focus_vergence`: RaySource::focus_vergence.
    double irradiance_factor(const LensRay& lens_ray, double focus_vergence) const {
        return port_factor_ * lens_.pixel_factor({lens_ray.falloff, 1}, 1 / focus_vergence);
    }

    /// The mean number in a pixel of this colour.
    double mean(const Spectrum& irradiance, std::size_t colour) const {
        double sum = 0;
        for (std::size_t b = 0; b < bands_; ++b) sum += per_irradiance_[colour][b] * irradiance[b];
        return sum;
    }

  private:
    std::size_t bands_;
    SensorModel lens_;
    double port_factor_ = 1;
    std::array<Spectrum, 3> per_irradiance_;  // by colour
};

}  // namespace uw
