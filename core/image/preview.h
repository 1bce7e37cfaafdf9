#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/image/film.h"

namespace uw {

/// An image to look at: 8-bit sRGB, three bytes per pixel, row by row. Only the film's window.
struct Preview {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;
};

/// The factor that brings the brighter parts of the film to a luminance of 0.8: the 99th
/// percentile over pixels with a ray (alpha > 0) and finite values; the brightest pixel where less
/// than 1 % shine at all. Empty if no pixel shines: the image is black, and the caller should say
/// so.
std::optional<double> automatic_exposure(const Film& film);

/// R, G and B times `exposure` as sRGB. Negative values, NaN and pixels without a ray are black.
Preview make_preview(const Film& film, double exposure);

}  // namespace uw
