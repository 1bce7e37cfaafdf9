#include "core/image/preview_exposure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/image/colour.h"
#include "core/image/image_file.h"

namespace uw {

namespace {

constexpr double k_percentile = 0.99;
constexpr double k_luminance_of_percentile = 0.8;

/// The luminances of the pixels that count, with those that show a lamp or without.
std::vector<float> luminances_of(const Film& film, bool with_lamps) {
    const PixelWindow& window = film.window();
    constexpr float k_not_counted = -std::numeric_limits<float>::infinity();
    std::vector<float> luminances(static_cast<std::size_t>(window.width()) *
                                  static_cast<std::size_t>(window.height()));
    parallel_for(static_cast<std::size_t>(window.height()), [&](std::size_t line) {
        const int y = window.y0 + static_cast<int>(line);
        float* out = &luminances[line * static_cast<std::size_t>(window.width())];
        for (int x = window.x0; x < window.x1; ++x) {
            const std::span<const float> pixel = film.pixel(x, y);
            const double brightness = luminance({pixel[k_red], pixel[k_green], pixel[k_blue]});
            const bool counts = pixel[k_alpha] > 0 && std::isfinite(brightness) &&
                                (with_lamps || !film.shows_lamp(x, y));
            *out++ = counts ? static_cast<float>(brightness) : k_not_counted;
        }
    });
    std::erase(luminances, k_not_counted);
    return luminances;
}

}  // namespace

std::optional<double> automatic_exposure(const Film& film) {
    std::vector<float> luminances = luminances_of(film, false);
    if (luminances.empty()) luminances = luminances_of(film, true);
    if (luminances.empty()) return std::nullopt;
    const auto last = static_cast<double>(luminances.size() - 1);
    const auto middle =
        luminances.begin() + static_cast<std::ptrdiff_t>(std::floor(k_percentile * last));
    std::size_t compared = 0;
    const auto is_darker = [&](float a, float b) {
        constexpr std::size_t k_between_stops = 1 << 16;
        if (++compared % k_between_stops == 0) throw_if_stopped();
        return a < b;
    };
    std::nth_element(luminances.begin(), middle, luminances.end(), is_darker);
    double bright = *middle;
    if (!(bright > 0)) bright = *std::max_element(middle, luminances.end());
    const double exposure = k_luminance_of_percentile / bright;
    if (!(bright > 0) || !std::isfinite(exposure)) return std::nullopt;
    return exposure;
}

RunExposure::RunExposure(const PreviewExposure& wanted) : kind_(wanted.kind) {
    if (kind_ == PreviewExposure::Kind::fixed) of_all_ = wanted.factor;
}

void RunExposure::keep(double first) {
    if (kind_ == PreviewExposure::Kind::first && !of_all_) of_all_ = first;
}

std::optional<double> RunExposure::of(const Film& film) {
    // A black image has none of its own. Rounded as its file states it, so that a run that
    // continues a sequence uses the same.
    if (kind_ == PreviewExposure::Kind::first && !of_all_)
        if (const auto own = automatic_exposure(film)) of_all_ = as_stated_in_png(*own);
    return of_all_;
}

}  // namespace uw
