#include "render/measures/pixel_values.h"

#include <algorithm>
#include <cmath>

namespace uw {

std::vector<PicturePlane> layer_planes(const Film& film, const LayerPlan& plan,
                                       std::initializer_list<Layer> layers, double gain) {
    const std::size_t bands = plan.band_count();
    std::vector<PicturePlane> planes;
    for (const Layer layer : layers)
        if (plan.has(layer))
            planes.push_back(
                {film.values().subspan(static_cast<std::size_t>(plan.first_channel(layer))),
                 film.channel_names().size(),
                 per_band(bands, [gain](std::size_t) { return gain; })});
    return planes;
}

double mean_of(std::span<const double> values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

double mean_between(std::span<double> values, double low, double high) {
    const auto count = static_cast<double>(values.size());
    const auto begin = static_cast<std::ptrdiff_t>(std::ceil(low * count));
    const auto end = static_cast<std::ptrdiff_t>(std::floor(high * count));
    if (begin >= end) {
        const auto middle = std::min(static_cast<std::ptrdiff_t>(0.5 * (low + high) * count),
                                     static_cast<std::ptrdiff_t>(values.size()) - 1);
        std::nth_element(values.begin(), values.begin() + middle, values.end());
        return values[static_cast<std::size_t>(middle)];
    }
    std::nth_element(values.begin(), values.begin() + begin, values.end());
    std::nth_element(values.begin() + begin, values.begin() + end, values.end());
    return mean_of({values.begin() + begin, values.begin() + end});
}

double percentile(std::span<double> values, double share) {
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = values.begin() + static_cast<std::ptrdiff_t>(place);
    std::nth_element(values.begin(), below, values.end());
    const double low = *below;
    if (below + 1 == values.end()) return low;
    return std::lerp(low, *std::min_element(below + 1, values.end()), place - std::floor(place));
}

}  // namespace uw
