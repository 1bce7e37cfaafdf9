#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "core/base/grid2d.h"
#include "core/image/film.h"

namespace uw {

class ColourView;  // core/image/colour_view.h

/// Header metadata by name. Numbers are stored as 32-bit floats in EXR, as text in PNG.
using ImageMetadata = std::map<std::string, std::variant<std::string, double>>;

/// A decoded image: row-major, top row first, channels interleaved. 8- and 16-bit values are scaled
/// to 0..1; no transfer function is undone and alpha is not premultiplied.
struct PixelImage {
    int width = 0, height = 0, channels = 0;
    std::vector<float> pixels;  // width * height * channels
    bool is_linear = false;     // values are light, whatever such images usually hold
};

/// To be called before anything is allocated for an image whose header says so. Throws InputError
/// if it is larger than 2^28 pixels, than `encoded_bytes` can hold, or than what fits into free
/// memory; messages call it `name`.
void check_image_size(std::int64_t width, std::int64_t height, int channels,
                      std::size_t encoded_bytes, const std::string& name);

/// An image of whole numbers, as cameras store them: grey or red, green and blue, row by row,
/// channels interleaved.
struct DigitalImage {
    int width = 0, height = 0;
    int channels = 1;      // or 3
    int bits = 8;          // or 16
    bool is_srgb = false;  // how values encode light, if files are to say so
    std::vector<std::uint16_t> values;

    std::size_t row_values() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
    }
};

/// An 8-bit sRGB colour: red, green, blue.
using Srgb8 = std::array<std::uint8_t, 3>;

/// The same with 16 bits each.
using Srgb16 = std::array<std::uint16_t, 3>;

/// An image for viewing; for a film, its window only.
using Preview = Grid2D<Srgb8>;
using Preview16 = Grid2D<Srgb16>;

/// R, G and B times `exposure` as sRGB, or through a view. NaN and pixels without a ray become
/// black, and so do negative values in sRGB.
Preview make_preview(const Film& film, double exposure, const ColourView* view = nullptr);
Preview16 make_preview16(const Film& film, double exposure, const ColourView* view = nullptr);

}  // namespace uw
