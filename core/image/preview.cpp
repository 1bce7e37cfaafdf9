#include "core/image/preview.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/colour/colour.h"

namespace uw {
namespace {

constexpr double k_percentile = 0.99;
constexpr double k_luminance_of_percentile = 0.8;

}  // namespace

std::optional<double> automatic_exposure(const Film& film) {
    const PixelWindow& window = film.window();
    std::vector<double> luminances;
    for (int y = window.y0; y < window.y1; ++y) {
        for (int x = window.x0; x < window.x1; ++x) {
            const std::span<const float> pixel = film.pixel(x, y);
            const double brightness = luminance({pixel[k_red], pixel[k_green], pixel[k_blue]});
            if (pixel[k_alpha] > 0 && std::isfinite(brightness)) luminances.push_back(brightness);
        }
    }
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
    const PixelWindow& window = film.window();
    Preview preview(window.width(), window.height());
    for (int y = 0; y < preview.height(); ++y) {
        for (int x = 0; x < preview.width(); ++x) {
            const std::span<const float> pixel = film.pixel(window.x0 + x, window.y0 + y);
            for (const FilmChannel channel : {k_red, k_green, k_blue}) {
                const double linear = pixel[k_alpha] > 0 ? exposure * pixel[channel] : 0.0;
                preview(x, y)[channel] =
                    static_cast<std::uint8_t>(std::lround(255 * srgb_encode(linear)));
            }
        }
    }
    return preview;
}

}  // namespace uw
