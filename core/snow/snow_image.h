#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/image/film.h"
#include "core/snow/footprint.h"

namespace uw {

/// What an image shows of one particle.
struct SnowSplat {
    double distance = 0;   // in water [m]
    std::uint64_t id = 0;  // SnowParticle::id
    /// The share of the light that the water scatters towards the pixel which comes from behind.
    float hidden = 0;
    std::uint32_t radiance = 0;  // index of its first band among SnowSplats::radiance
    Footprint footprint;
};

struct SnowSplats {
    std::vector<SnowSplat> splats;
    std::vector<float> radiance;  // of each particle, by band [W m^-2 sr^-1]

    void append(const SnowSplats& more);
};

/// What the particles in front of a pixel add to it and hide from it.
struct SnowPixel {
    std::span<const float> radiance;  // by band, of all particles [W m^-2 sr^-1]
    double transparency = 1;          // the share of a surface that they leave
    double water = 1;                 // the share of the water's light that they leave
    double held = 0;  // distance of the first that covers at least half of the pixel [m]; 0: none
};

/// The particles of an image, each before those behind it.
class SnowImage {
  public:
    /// Draws `splats` into the pixels of `window`, on all threads. The same particles give the same
    /// pixels in any order and any window.
    SnowImage(const PixelWindow& window, std::size_t bands, const SnowSplats& splats);

    SnowPixel pixel(int x, int y) const;

  private:
    void draw(const SnowSplat& splat, std::span<const float> radiance, const PixelWindow& tile);
    std::span<float> values(int x, int y);

    PixelWindow window_;
    std::size_t bands_;
    Grid2D<float> values_;  // of each pixel: bands_ of radiance, then what is left and held
};

}  // namespace uw
