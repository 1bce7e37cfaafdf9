#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/base/grid2d.h"
#include "core/image/film.h"

namespace uw {

/// An 8-bit sRGB colour: red, green, blue.
using Srgb8 = std::array<std::uint8_t, 3>;

/// The same with 16 bits each.
using Srgb16 = std::array<std::uint16_t, 3>;

/// An image for viewing; for a film, its window only.
using Preview = Grid2D<Srgb8>;
using Preview16 = Grid2D<Srgb16>;

/// The factor that brings the brighter parts of the film to a luminance of 0.8: the 99th percentile
/// over the pixels with a ray (alpha > 0) and finite values, or the brightest pixel if fewer than 1
/// % are not black. Empty if all are black, which the caller should report.
std::optional<double> automatic_exposure(const Film& film);

/// R, G and B times `exposure` as sRGB. Negative values, NaN and pixels without a ray become black.
Preview make_preview(const Film& film, double exposure);
Preview16 make_preview16(const Film& film, double exposure);

}  // namespace uw
