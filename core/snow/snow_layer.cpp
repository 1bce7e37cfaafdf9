#include "core/snow/snow_layer.h"

#include <cmath>

namespace uw {

Spectrum SnowLayer::radiance(int x, int y, double end, const Spectrum& surface,
                             const Spectrum& water) const {
    const SnowPixel snow = image_.pixel(x, y);
    const double left = snow.transparency * std::exp(depth_(end)) - 1;
    const double water_left = snow.water / veil_.mean_transmittance(x + 0.5, y + 0.5, end) - 1;
    return per_band(snow.radiance.size(), [&](std::size_t b) {
        return static_cast<double>(snow.radiance[b]) + left * surface[b] + water_left * water[b];
    });
}

}  // namespace uw
