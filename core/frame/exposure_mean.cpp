#include "core/frame/exposure_mean.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/parallel.h"

namespace uw {

ExposureMean::ExposureMean(const LayerPlan& plan, const LightTerms& terms, const BandColour& colour,
                           Film& mean)
    : plan_(plan), terms_(terms), colour_(colour), mean_(mean) {
    // Lamps and orders follow the layers: all channels but those of other kinds are means.
    std::vector<bool> is_mean(mean.channel_names().size(), true);
    std::vector<float> place(is_mean.size());
    for (const PixelLayer& layer : k_pixel_layers) {
        const bool is_plain =
            layer.of_exposure && layer.layer != Layer::error && layer.layer != Layer::transmittance;
        if (is_plain || !plan.has(layer.layer)) continue;
        const std::span<float> own = plan.channels(layer.layer, place);
        const auto first = static_cast<std::size_t>(own.data() - place.data());
        std::fill_n(is_mean.begin() + static_cast<std::ptrdiff_t>(first), own.size(), false);
    }
    for (std::size_t channel = 0; channel < is_mean.size(); ++channel)
        if (is_mean[channel]) channels_.push_back(channel);
    shares_.assign(static_cast<std::size_t>(mean.window().height()), 0.0F);
    if (plan.has(Layer::transmittance))
        on_surface_.assign(mean.window().width(), mean.window().height());
}

void ExposureMean::add(const Film& part, const RowShare& share) {
    const PixelWindow& window = part.window();
    const int x0 = mean_.window().x0, y0 = mean_.window().y0;
    parallel_for(static_cast<std::size_t>(window.height()), [&](std::size_t line) {
        const int y = window.y0 + static_cast<int>(line);
        const auto weight = static_cast<float>(share(y));
        if (weight == 0) return;
        float& so_far = shares_[static_cast<std::size_t>(y - y0)];
        so_far += weight;
        for (int x = window.x0; x < window.x1; ++x) {
            add_pixel(part.pixel(x, y), weight, so_far, mean_.pixel(x, y));
            if (!on_surface_.empty())
                add_transmittance(part.pixel(x, y), weight, mean_.pixel(x, y),
                                  on_surface_(x - x0, y - y0));
        }
    });
}

// What all parts have alike stays as it is, to the bit.
void ExposureMean::add_pixel(std::span<const float> part, float share, float share_so_far,
                             std::span<float> mean) const {
    const float weight = share / share_so_far;
    for (const std::size_t channel : channels_)
        mean[channel] += weight * (part[channel] - mean[channel]);
    if (!plan_.has(Layer::error)) return;
    const auto first = static_cast<std::size_t>(plan_.first_channel(Layer::error));
    for (std::size_t b = 0; b < plan_.band_count(); ++b)
        mean[first + b] += share * part[first + b] * (share * part[first + b]);
}

void ExposureMean::add_transmittance(std::span<const float> part, float share,
                                     std::span<float> mean, float& on_surface) const {
    const auto first = static_cast<std::size_t>(plan_.first_channel(Layer::transmittance));
    const std::span<const float> seen = part.subspan(first, plan_.band_count());
    if (std::ranges::none_of(seen, [](float value) { return value > 0; })) return;
    on_surface += share;
    for (std::size_t b = 0; b < seen.size(); ++b)
        mean[first + b] += share / on_surface * (seen[b] - mean[first + b]);
}

void ExposureMean::finish() {
    const PixelWindow& window = mean_.window();
    parallel_for(static_cast<std::size_t>(window.height()), [&](std::size_t line) {
        const int y = window.y0 + static_cast<int>(line);
        for (int x = window.x0; x < window.x1; ++x) {
            const std::span<float> pixel = mean_.pixel(x, y);
            if (plan_.has(Layer::error))  // whose variances add up
                for (float& value : plan_.channels(Layer::error, pixel)) value = std::sqrt(value);
            restore_sums(plan_, terms_, colour_, pixel);
        }
    });
}

}  // namespace uw
