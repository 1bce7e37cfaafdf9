#include "core/image/preview.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "core/colour/colour.h"

namespace uw {
namespace {

constexpr double k_percentile = 0.99;
constexpr double k_luminance_of_percentile = 0.8;

template <typename Visit>
void for_each_pixel(const Film& film, const Visit& visit) {
    const PixelWindow& window = film.window();
    for (int y = window.y0; y < window.y1; ++y) {
        for (int x = window.x0; x < window.x1; ++x) visit(film.pixel(x, y));
    }
}

}  // namespace

std::optional<double> automatic_exposure(const Film& film) {
    std::vector<double> luminances;
    for_each_pixel(film, [&](std::span<const float> pixel) {
        const double y = luminance({pixel[k_red], pixel[k_green], pixel[k_blue]});
        if (pixel[k_alpha] > 0 && std::isfinite(y)) luminances.push_back(y);
    });
    if (luminances.empty()) return std::nullopt;
    const auto last = static_cast<double>(luminances.size() - 1);
    const auto middle =
        luminances.begin() + static_cast<std::ptrdiff_t>(std::floor(k_percentile * last));
    std::nth_element(luminances.begin(), middle, luminances.end());
    double bright = *middle;
    if (!(bright > 0)) bright = *std::max_element(middle, luminances.end());
    const double exposure = k_luminance_of_percentile / bright;
    if (!(bright > 0) || !std::isfinite(exposure)) return std::nullopt;
    return exposure;
}

Preview make_preview(const Film& film, double exposure) {
    Preview preview{film.window().width(), film.window().height(), {}};
    preview.rgb.reserve(3 * static_cast<std::size_t>(preview.width) *
                        static_cast<std::size_t>(preview.height));
    for_each_pixel(film, [&](std::span<const float> pixel) {
        for (const FilmChannel channel : {k_red, k_green, k_blue}) {
            const double linear = pixel[k_alpha] > 0 ? exposure * pixel[channel] : 0.0;
            preview.rgb.push_back(
                static_cast<std::uint8_t>(std::lround(255 * srgb_encode(linear))));
        }
    });
    return preview;
}

}  // namespace uw
