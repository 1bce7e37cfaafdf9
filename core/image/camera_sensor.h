#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/image/film.h"
#include "core/image/image_quantity.h"
#include "core/image/layers.h"
#include "core/scene/scene_desc.h"
#include "core/scene/sensor_desc.h"

namespace uw {

/// How many photoelectrons light sets free in the pixels of a scene's sensor
/// (docs/camera-image.md): eta E A t lambda / (h c), summed over the bands, with E the irradiance
/// behind the lens.
class Photoelectrons {
  public:
    /// Describes the camera of a scene whose sensors the scene reader has checked. Throws
    /// InputError for a table of efficiencies that is not valid or in which a colour sees none of
    /// the bands; IoError if it cannot be read.
    explicit Photoelectrons(const SceneDesc& scene);

    /// Irradiance on the sensor per radiance in water [sr], for the pixel that `lens_ray` belongs
    /// to: the lens's factor (SensorModel) and, behind a port, (n_air / n_water)^2 unless the
    /// image's radiance is in air already. The port's transmittance is in the radiance.
    /// `focus_vergence`: RaySource::focus_vergence.
    double irradiance_factor(const LensRay& lens_ray, double focus_vergence) const {
        return port_factor_ * lens_.pixel_factor({lens_ray.falloff, 1}, 1 / focus_vergence);
    }

    /// The mean number in a pixel of this colour per irradiance in a band.
    double per_irradiance(std::size_t colour, std::size_t band) const {
        return per_irradiance_[colour][band];
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

/// Which image of a camera: all of its noise differs from that of every other.
struct ImageIdentity {
    std::string_view camera{};  ///< of a rig, by its name
    std::int64_t frame = 0;
};

/// Turns photoelectrons into digital numbers, by the linear model of EMVA standard 1288:
///
///     y = K (min(Poisson((1 + PRNU) mu + I t), full well) + DSNU + read noise) + black level,
///
/// rounded and limited to 0..2^bits - 1. Random numbers depend on the sensor's seed, the image
/// (those of PRNU and DSNU on the camera only, as they belong to its pixels), the pixel of the
/// whole image and the colour, and on nothing else.
class SensorReadout {
  public:
    /// Precondition: the sensor has an exposure time (complete_sensors).
    SensorReadout(const SensorDesc& desc, const ImageIdentity& image);

    /// The number of pixel (x, y), or that of one of its colours, for a mean of `photoelectrons`.
    /// Whole. Thread safe.
    double number(double photoelectrons, int x, int y, std::size_t colour = 0) const;

  private:
    SensorDesc desc_;
    double gain_, dark_electrons_;
    std::uint64_t fixed_seed_, image_seed_;
};

/// What the digital numbers of a scene's sensor are in the mean, before they are rounded: those of
/// SensorReadout without noise.
class MeanNumbers {
  public:
    /// As Photoelectrons. Precondition: the camera has a sensor with an exposure time.
    explicit MeanNumbers(const SceneDesc& scene);

    /// In a pixel of this colour; Photoelectrons::irradiance_factor times the radiance in water.
    double at(const Spectrum& irradiance, std::size_t colour) const;
    /// How they grow with the irradiance in a band; not at all in a full well.
    double slope(const Spectrum& irradiance, std::size_t colour, std::size_t band) const;
    /// Without light.
    double dark() const;
    const Photoelectrons& photoelectrons() const { return photoelectrons_; }

  private:
    double electrons(const Spectrum& irradiance, std::size_t colour) const;

    Photoelectrons photoelectrons_;
    SensorDesc sensor_;
};

/// Which colour pixel (x, y) of a mosaic sees: 0 red, 1 green, 2 blue. 0 for other sensors.
std::size_t colour_at(SensorMosaic mosaic, int x, int y);

/// The sensor of a scene's camera: turns the light of an image into digital numbers.
class CameraSensor {
  public:
    /// The noise is that of frame `frame`. Throws as Photoelectrons. Precondition: the camera has a
    /// sensor.
    CameraSensor(const SceneDesc& scene, std::int64_t frame);

    /// Fills the layer `sensor` of all pixels from the light of every band: `plan` has that layer
    /// and, unless there are three bands, `total`. On all permitted threads; neither their number
    /// nor the window changes a pixel. `rays` are those of the camera.
    void expose(const RaySource& rays, const LayerPlan& plan, Film& film) const;

  private:
    SensorMosaic mosaic_;
    Photoelectrons photoelectrons_;
    SensorReadout readout_;
};

}  // namespace uw
