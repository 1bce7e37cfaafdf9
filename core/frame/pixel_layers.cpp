#include "core/frame/pixel_layers.h"

#include <algorithm>
#include <utility>

#include "core/image/film.h"

namespace uw {

namespace {

void store_vector(double x, double y, double z, std::span<float> channels) {
    channels[0] = static_cast<float>(x);
    channels[1] = static_cast<float>(y);
    channels[2] = static_cast<float>(z);
}

void store_colour(const PixelResult& pixel, std::size_t bands, const BandColour& colour,
                  std::span<float> channels) {
    std::array<float, k_max_bands> rounded{};
    layer_channels::total(pixel, std::span(rounded).first(bands));
    const LinearRgb rgb =
        colour(per_band(bands, [&](std::size_t b) { return static_cast<double>(rounded[b]); }));
    for (std::size_t i = 0; i < 3; ++i) channels[i] = static_cast<float>(rgb[i]);
}

void add_channels(std::span<float> sum, std::span<const float> more) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += more[i];
}

}  // namespace

void PixelResult::reset(std::size_t lamp_count) {
    std::vector<Spectrum> storage = std::move(lamps);
    *this = PixelResult{};
    lamps = std::move(storage);
    lamps.assign(lamp_count, Spectrum{});
}

namespace layer_channels {

void total(const PixelResult& pixel, std::span<float> channels) {
    const double factor = pixel.pixel_factor;
    for (std::size_t b = 0; b < channels.size(); ++b)
        channels[b] = static_cast<float>(factor * pixel.direct[b]) +
                      static_cast<float>(factor * pixel.forward[b]) +
                      static_cast<float>(factor * pixel.backscatter[b]);
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
    for (const PixelLayer& layer : k_pixel_layers) {
        if (!plan.has(layer.layer)) continue;
        const std::span<float> own = plan.channels(layer.layer, channels);
        if (layer.of_hit && !pixel.has_hit)
            std::ranges::fill(own, 0.0F);
        else
            layer.fill(pixel, own);
    }
    for (std::size_t j = 0; j < pixel.lamps.size(); ++j) {
        const std::span<float> own = plan.lamp_channels(j, channels);
        for (std::size_t b = 0; b < own.size(); ++b)
            own[b] = static_cast<float>(pixel.pixel_factor * pixel.lamps[j][b]);
    }
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

}  // namespace uw
