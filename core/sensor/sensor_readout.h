#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/scene/sensor_desc.h"

namespace uw {

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

/// Which colour pixel (x, y) of a mosaic sees: 0 red, 1 green, 2 blue. 0 for other sensors.
std::size_t colour_at(SensorMosaic mosaic, int x, int y);

}  // namespace uw
