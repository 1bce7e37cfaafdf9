#pragma once

#include <functional>

#include "core/base/spectrum.h"
#include "core/snow/snow_image.h"
#include "core/snow/water_veil.h"

namespace uw {

/// What snow changes in the light of each pixel of an image: the particles' own light, and what
/// they hide.
///
/// The water's coefficients hold the mean of what the particles drawn take away on the light's way
/// to the camera. As the particles do so themselves, what lies behind a mean depth of them is
/// brightened by e^depth first: over many seeds nothing is taken away twice.
class SnowLayer {
  public:
    /// `depth`: of the particles drawn, up to a distance (SnowModel::drawn_depth).
    SnowLayer(SnowImage image, WaterVeil veil, std::function<double(double distance)> depth)
        : image_(std::move(image)), veil_(std::move(veil)), depth_(std::move(depth)) {}

    /// Radiance [W m^-2 sr^-1], negative where more is hidden than added, of a pixel whose water
    /// ends at `end` [m] and scatters `water` towards the camera, where `surface` is its other
    /// light.
    Spectrum radiance(int x, int y, double end, const Spectrum& surface,
                      const Spectrum& water) const;
    /// Distance of the particle that covers at least half of the pixel [m]; 0: none does.
    double held(int x, int y) const { return image_.pixel(x, y).held; }

  private:
    SnowImage image_;
    WaterVeil veil_;
    std::function<double(double distance)> depth_;
};

}  // namespace uw
