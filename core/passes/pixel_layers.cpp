#include "core/passes/pixel_layers.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/base/parallel.h"
#include "core/image/film.h"

namespace uw {

namespace {

void store_vector(double x, double y, double z, std::span<float> channels) {
    channels[0] = static_cast<float>(x);
    channels[1] = static_cast<float>(y);
    channels[2] = static_cast<float>(z);
}

void store_colour(std::span<const float> total, const BandColour& colour,
                  std::span<float> channels) {
    const LinearRgb rgb = colour(
        per_band(total.size(), [&](std::size_t b) { return static_cast<double>(total[b]); }));
    for (std::size_t i = 0; i < 3; ++i) channels[i] = static_cast<float>(rgb[i]);
}

void store_colour(const PixelResult& pixel, std::size_t bands, const BandColour& colour,
                  std::span<float> channels) {
    std::array<float, k_max_bands> rounded{};
    const std::span<float> total = std::span(rounded).first(bands);
    layer_channels::total(pixel, total);
    store_colour(total, colour, channels);
}

void store_radiance(const Spectrum& radiance, double factor, std::span<float> channels) {
    for (std::size_t b = 0; b < channels.size(); ++b)
        channels[b] = static_cast<float>(factor * radiance[b]);
}

void add_channels(std::span<float> sum, std::span<const float> more) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += more[i];
}

void mix_channels(std::span<float> mean, std::span<const float> more, double weight) {
    for (std::size_t i = 0; i < mean.size(); ++i) {
        const auto before = static_cast<double>(mean[i]);
        mean[i] = static_cast<float>(before + weight * (static_cast<double>(more[i]) - before));
    }
}

void store_layer(const PixelLayer& layer, const PixelResult& pixel, const LayerPlan& plan,
                 std::span<float> channels) {
    if (!plan.has(layer.layer)) return;
    const std::span<float> own = plan.channels(layer.layer, channels);
    if (layer.of_hit && !pixel.has_hit)
        std::ranges::fill(own, 0.0F);
    else
        layer.fill(pixel, own);
}

}  // namespace

void PixelResult::reset(std::size_t lamp_count, std::size_t bands) {
    alpha = lit = depth_z = range = path = 0;
    pixel_factor = 1;
    has_hit = false;
    hit = {};
    constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
    flow = flow_back = disparity = {k_none, k_none};
    flow_occluded = disparity_occluded = k_none;
    // Bands are few: band by band is faster than spectrum by spectrum.
    for (std::size_t b = 0; b < bands; ++b)
        for (Spectrum* const values :
             {&direct, &forward, &backscatter, &backscatter_first, &multiple_volume,
              &multiple_surface, &snow, &error, &irradiance, &exitance, &clean, &transmittance})
            (*values)[b] = 0;
    lamps.assign(lamp_count, Spectrum{});
    orders.clear();
    reflections.clear();
}

namespace layer_channels {

void multiple(const PixelResult& pixel, std::span<float> channels) {
    const double factor = pixel.pixel_factor;
    for (std::size_t b = 0; b < channels.size(); ++b)
        channels[b] = static_cast<float>(factor * pixel.multiple_volume[b]) +
                      static_cast<float>(factor * pixel.multiple_surface[b]);
}

void total(const PixelResult& pixel, std::span<float> channels) {
    const double factor = pixel.pixel_factor;
    multiple(pixel, channels);
    for (std::size_t b = 0; b < channels.size(); ++b) {
        const float sum = static_cast<float>(factor * pixel.direct[b]) +
                          static_cast<float>(factor * pixel.forward[b]) +
                          static_cast<float>(factor * pixel.backscatter[b]) + channels[b] +
                          static_cast<float>(factor * pixel.snow[b]);
        channels[b] = std::max(sum, 0.0F);
    }
}

void albedo(const PixelResult& pixel, std::span<float> channels) {
    for (std::size_t b = 0; b < channels.size(); ++b)
        channels[b] = static_cast<float>(pixel.hit.reflectance[b]);
}

void normal(const PixelResult& pixel, std::span<float> channels) {
    store_vector(pixel.hit.normal.x, pixel.hit.normal.y, pixel.hit.normal.z, channels);
}

void position(const PixelResult& pixel, std::span<float> channels) {
    store_vector(pixel.hit.position.x, pixel.hit.position.y, pixel.hit.position.z, channels);
}

void id(const PixelResult& pixel, std::span<float> channels) {
    channels[0] = static_cast<float>(pixel.hit.object_id);
}

void material(const PixelResult& pixel, std::span<float> channels) {
    channels[0] = static_cast<float>(pixel.hit.material_id);
}

}  // namespace layer_channels

InScatterParts in_scatter_parts(const LayerPlan& plan) {
    return {.lamps = plan.has_lamps(),
            .first_slab = std::ranges::any_of(k_pixel_layers, [&](const PixelLayer& layer) {
                return layer.needs_first_slab && plan.has(layer.layer);
            })};
}

void store_pixel(const PixelResult& pixel, const LayerPlan& plan, const BandColour& colour,
                 std::span<float> channels) {
    store_colour(pixel, plan.band_count(), colour, channels);
    channels[k_alpha] = static_cast<float>(pixel.alpha);
    for (const PixelLayer& layer : k_pixel_layers) store_layer(layer, pixel, plan, channels);
    for (std::size_t j = 0; j < pixel.lamps.size(); ++j)
        store_radiance(pixel.lamps[j], pixel.pixel_factor, plan.lamp_channels(j, channels));
    for (std::size_t order = 0; order < plan.order_count(); ++order) {
        store_radiance(pixel.orders[order], pixel.pixel_factor,
                       plan.order_channels(order, channels));
        store_radiance(pixel.reflections[order], pixel.pixel_factor,
                       plan.reflection_channels(order, channels));
    }
}

void store_truth(const PixelResult& pixel, const LayerPlan& plan, std::span<float> channels) {
    for (const PixelLayer& layer : k_pixel_layers)
        if (!layer.of_exposure) store_layer(layer, pixel, plan, channels);
}

void restore_sums(const LayerPlan& plan, const LightTerms& terms, const BandColour& colour,
                  std::span<float> channels) {
    const auto layer = [&](Layer which) { return plan.channels(which, channels); };
    std::array<float, k_max_bands> multiple{}, sums{};
    const std::span<float> more = std::span(multiple).first(plan.band_count());
    if (plan.has(Layer::multiple_volume) && plan.has(Layer::multiple_surface)) {
        std::ranges::copy(layer(Layer::multiple_volume), more.begin());
        add_channels(more, layer(Layer::multiple_surface));
        if (plan.has(Layer::multiple)) std::ranges::copy(more, layer(Layer::multiple).begin());
    } else if (plan.has(Layer::multiple)) {
        std::ranges::copy(layer(Layer::multiple), more.begin());
    } else if (terms.multiple) {
        return;
    }
    if (!plan.has(Layer::direct) || !plan.has(Layer::backscatter)) return;
    if (terms.forward && !plan.has(Layer::forward)) return;
    if (terms.snow && !plan.has(Layer::snow)) return;
    const std::span<float> total = std::span(sums).first(plan.band_count());
    std::ranges::copy(layer(Layer::direct), total.begin());
    if (terms.forward) add_channels(total, layer(Layer::forward));
    add_channels(total, layer(Layer::backscatter));
    add_channels(total, more);
    if (terms.snow) {
        add_channels(total, layer(Layer::snow));
        for (float& sum : total) sum = std::max(sum, 0.0F);
    }
    if (plan.has(Layer::total)) std::ranges::copy(total, layer(Layer::total).begin());
    store_colour(total, colour, channels);
}

void merge_paths(const PixelResult& pixel, double weight, const LayerPlan& plan,
                 const BandColour& colour, std::span<float> channels) {
    thread_local std::vector<float> fresh;
    fresh.resize(channels.size());
    store_pixel(pixel, plan, colour, fresh);
    const auto merge = [&](const auto& channels_in) {
        mix_channels(channels_in(channels), channels_in(std::span(fresh)), weight);
    };
    merge([](std::span<float> all) { return all.first(k_alpha + 1); });
    for (const PixelLayer& layer : k_pixel_layers)
        if (layer.of_paths && plan.has(layer.layer))
            merge([&](std::span<float> all) { return plan.channels(layer.layer, all); });
    for (std::size_t j = 0; j < pixel.lamps.size(); ++j)
        merge([&](std::span<float> all) { return plan.lamp_channels(j, all); });
    for (std::size_t order = 0; order < plan.order_count(); ++order) {
        merge([&](std::span<float> all) { return plan.order_channels(order, all); });
        merge([&](std::span<float> all) { return plan.reflection_channels(order, all); });
    }
    // Nothing is scattered forward by a blur, and no snow is drawn.
    restore_sums(plan, {.forward = false, .multiple = true, .snow = false}, colour, channels);
}

void store_forward_scatter(const PixelResult& pixel, const LayerPlan& plan,
                           const BandColour& colour, std::span<float> channels) {
    using Effect = PixelLayer::ForwardScatter;
    store_colour(pixel, plan.band_count(), colour, channels);
    std::array<float, k_max_bands> added{};
    const std::span<float> more = std::span(added).first(plan.band_count());
    for (const PixelLayer& layer : k_pixel_layers) {
        if (layer.forward_scatter == Effect::leaves || !plan.has(layer.layer)) continue;
        const std::span<float> own = plan.channels(layer.layer, channels);
        if (layer.forward_scatter == Effect::replaces) {
            layer.fill(pixel, own);
        } else {
            layer.fill(pixel, more);
            add_channels(own, more);
        }
    }
}

void add_forward_scatter_of_lamp(const PixelResult& pixel, const LayerPlan& plan, std::size_t lamp,
                                 std::span<float> channels) {
    const std::span<float> own = plan.lamp_channels(lamp, channels);
    for (std::size_t b = 0; b < own.size(); ++b)
        own[b] += static_cast<float>(pixel.pixel_factor * pixel.forward[b]) +
                  static_cast<float>(pixel.pixel_factor * pixel.backscatter[b]);
}

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
