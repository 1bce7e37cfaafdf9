#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/base/grid2d.h"
#include "core/image/film.h"

namespace uw {

/// A sample of a deep pixel (OpenEXR, "Interpreting Deep Pixels"): a stretch of water from `z` to
/// `z_back`, or a surface where both are equal. Flattened, front to back, a pixel is the sum of its
/// colours, each times the product of (1 - alpha) of all samples before.
struct DeepSample {
    float z = 0, z_back = 0;        ///< along the camera's axis [m]
    std::array<float, 3> colour{};  ///< R, G and B, premultiplied; flattened those of the image
    float alpha = 0;                ///< the fraction of what lies behind that the sample hides
};

/// The deep pixels of a window of an image, each sorted by distance. Different pixels may be
/// written from different threads.
class DeepImage {
  public:
    /// `most`: the maximum number of samples of a pixel. Throws as require_memory if the image
    /// might not fit into memory with so many.
    DeepImage(int width, int height, const PixelWindow& window, int most);

    int width() const { return width_; }
    int height() const { return height_; }
    const PixelWindow& window() const { return window_; }
    int most() const { return most_; }
    std::size_t pixel_count() const { return pixels_.size(); }
    /// The number of samples of all pixels.
    std::size_t sample_count() const;

    /// The samples of a pixel of the window, by its coordinates in the full image.
    std::vector<DeepSample>& pixel(int x, int y) { return pixels_(x - window_.x0, y - window_.y0); }
    const std::vector<DeepSample>& pixel(int x, int y) const {
        return pixels_(x - window_.x0, y - window_.y0);
    }

  private:
    int width_, height_;
    PixelWindow window_;
    int most_;
    Grid2D<std::vector<DeepSample>> pixels_;
};

}  // namespace uw
