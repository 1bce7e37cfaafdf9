#include "core/snow/beyond_snow.h"

#include <algorithm>
#include <utility>

namespace uw {

BeyondSnow::BeyondSnow(std::unique_ptr<const Integrator> water,
                       std::unique_ptr<const Integrator> snow, std::vector<Part> parts)
    : water_(std::move(water)), snow_(std::move(snow)), parts_(std::move(parts)) {
    std::ranges::sort(parts_, {}, &Part::range);
}

void BeyondSnow::in_scatter(const Ray& ray, std::span<const double> distances,
                            InScatter& result) const {
    water_->in_scatter(ray, distances, result);
    add_beyond(ray, 0, distances, result);
}

void BeyondSnow::in_scatter_from(const Ray& ray, double begin, std::span<const double> distances,
                                 InScatter& result) const {
    water_->in_scatter_from(ray, begin, distances, result);
    add_beyond(ray, begin, distances, result);
}

void BeyondSnow::add_beyond(const Ray& ray, double begin, std::span<const double> distances,
                            InScatter& result) const {
    const double from = std::max(begin, parts_.front().range);
    const double end = distances.back();
    if (!(end > from)) return;
    thread_local std::vector<double> stops;
    thread_local InScatter light;
    stops.clear();
    for (const double distance : distances)
        if (distance > from) stops.push_back(distance);
    for (const Part& part : parts_)
        if (part.range > from && part.range < end) stops.push_back(part.range);
    std::ranges::sort(stops);
    snow_->in_scatter_from(ray, from, stops, light);
    const auto up_to = [&](double distance, std::size_t lamp) {
        if (!(distance > from)) return Spectrum{};
        const auto stop = std::ranges::lower_bound(stops, distance);
        return light.at(static_cast<std::size_t>(stop - stops.begin()), lamp);
    };
    for (std::size_t i = 0; i < distances.size(); ++i)
        for (std::size_t lamp = 0; lamp < result.lamp_count(); ++lamp)
            for (const Part& part : parts_) {
                if (part.range >= distances[i]) continue;
                Spectrum beyond = up_to(distances[i], lamp) - up_to(part.range, lamp);
                // Of few slabs, the light of a part may be more than that of the whole.
                for (double& radiance : beyond.values) radiance = std::max(radiance, 0.0);
                result.at(i, lamp) += part.share * beyond;
            }
}

}  // namespace uw
