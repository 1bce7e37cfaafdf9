#include "core/image/pixel_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/image/colour.h"
#include "core/image/colour_view.h"

namespace uw {

void check_image_size(std::int64_t width, std::int64_t height, int channels,
                      std::size_t encoded_bytes, const std::string& name) {
    constexpr std::int64_t k_max_pixels = std::int64_t{1} << 28;
    // No codec in use packs more values than this into a byte (deflate: 1032), so that a forged
    // size in the header of a small file does not allocate gigabytes.
    constexpr std::int64_t k_max_values_per_byte = 4096;
    if (width > k_max_pixels || height > k_max_pixels || width * height > k_max_pixels) {
        throw InputError(
            fmt::format("{}: {} x {} pixels are more than the 2^28 supported; "
                        "scale the image down",
                        name, width, height));
    }
    if (width * height * channels / k_max_values_per_byte >
        static_cast<std::int64_t>(encoded_bytes)) {
        throw InputError(
            fmt::format("{}: {} bytes cannot hold {} x {} pixels; the file is truncated", name,
                        encoded_bytes, width, height));
    }
    // A byte or two as the codec gives it, and a float.
    constexpr double k_bytes_per_value = 5;
    require_memory(k_bytes_per_value * static_cast<double>(width * height * channels),
                   fmt::format("{}: {} x {} pixels need", name, width, height),
                   "scale the image down");
}

namespace {

/// `encode`: linear to a value of the colour.
template <class Colour, class Encode>
Grid2D<Colour> preview_of(const Film& film, double exposure, const Encode& encode) {
    const PixelWindow& window = film.window();
    Grid2D<Colour> preview(window.width(), window.height());
    parallel_for(static_cast<std::size_t>(window.height()), [&](std::size_t line) {
        const int y = static_cast<int>(line);
        int x = window.x0;
        for (Colour& out : preview.row(y)) {
            const std::span<const float> pixel = film.pixel(x++, window.y0 + y);
            if (!(pixel[k_alpha] > 0)) continue;  // black
            for (const FilmChannel channel : {k_red, k_green, k_blue})
                out[channel] = encode(exposure * pixel[channel]);
        }
    });
    return preview;
}

/// Through a view: its values, rounded to whole numbers.
template <class Colour>
Grid2D<Colour> preview_of(const Film& film, double exposure, const ColourView& view) {
    using Value = typename Colour::value_type;
    constexpr float k_most = std::numeric_limits<Value>::max();
    const PixelWindow& window = film.window();
    Grid2D<Colour> preview(window.width(), window.height());
    parallel_for(static_cast<std::size_t>(window.height()), [&](std::size_t line) {
        const int y = window.y0 + static_cast<int>(line);
        std::vector<float> rgb;
        for (int x = window.x0; x < window.x1; ++x)
            for (const float value : film.pixel(x, y).first(3)) {
                const auto exposed = static_cast<float>(exposure * static_cast<double>(value));
                rgb.push_back(std::isnan(exposed) ? 0.0F : exposed);
            }
        view.apply(rgb);
        int x = window.x0;
        const float* value = rgb.data();
        for (Colour& out : preview.row(static_cast<int>(line))) {
            const bool has_ray = film.pixel(x++, y)[k_alpha] > 0;  // else black
            for (Value& stored : out) {
                const float shown = *value++;
                if (has_ray && shown > 0)
                    stored = static_cast<Value>(std::lround(k_most * std::min(shown, 1.0F)));
            }
        }
    });
    return preview;
}

}  // namespace

Preview make_preview(const Film& film, double exposure, const ColourView* view) {
    if (view != nullptr) return preview_of<Srgb8>(film, exposure, *view);
    return preview_of<Srgb8>(film, exposure, srgb_bytes());
}

Preview16 make_preview16(const Film& film, double exposure, const ColourView* view) {
    if (view != nullptr) return preview_of<Srgb16>(film, exposure, *view);
    return preview_of<Srgb16>(film, exposure, [](double linear) {
        return static_cast<std::uint16_t>(std::lround(65535 * srgb_encode(linear)));
    });
}

}  // namespace uw
