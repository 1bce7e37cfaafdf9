#include "core/passes/pixel_layers.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>

#include "core/base/parallel.h"
#include "core/image/cryptomatte.h"
#include "core/image/film.h"

namespace uw {

namespace {

/// Stores a number, or one for each channel, times `factor`.
template <class Values>
void store(const Values& values, std::span<float> channels, double factor = 1) {
    if constexpr (std::is_arithmetic_v<Values>)
        channels[0] = static_cast<float>(factor * values);
    else
        for (std::size_t i = 0; i < channels.size(); ++i)
            channels[i] = static_cast<float>(factor * values[static_cast<int>(i)]);
}

/// Stores values without a factor.
template <auto values>
void fill(const PixelResult& pixel, std::span<float> channels) {
    store(pixel.*values, channels);
}

template <auto values>
void fill_from_hit(const PixelResult& pixel, std::span<float> channels) {
    store(pixel.hit.*values, channels);
}

/// Stores radiance, which images contain multiplied by the pixel's factor.
template <auto values>
void fill_radiance(const PixelResult& pixel, std::span<float> channels) {
    store(pixel.*values, channels, pixel.pixel_factor);
}

/// Stores the sum of `multiple_volume` and `multiple_surface`, each rounded to float before the
/// addition.
void fill_multiple(const PixelResult& pixel, std::span<float> channels) {
    const double factor = pixel.pixel_factor;
    for (std::size_t b = 0; b < channels.size(); ++b)
        channels[b] = static_cast<float>(factor * pixel.multiple_volume[b]) +
                      static_cast<float>(factor * pixel.multiple_surface[b]);
}

/// Stores the sum of direct, forward, backscatter, `multiple` and snow, in this order, each rounded
/// to float before the addition, so that in the image they sum to the total to the bit. The sum is
/// clamped to 0, as rounding may make it negative where snow hides all other light.
void fill_total(const PixelResult& pixel, std::span<float> channels) {
    const double factor = pixel.pixel_factor;
    fill_multiple(pixel, channels);
    for (std::size_t b = 0; b < channels.size(); ++b) {
        const float sum = static_cast<float>(factor * pixel.direct[b]) +
                          static_cast<float>(factor * pixel.forward[b]) +
                          static_cast<float>(factor * pixel.backscatter[b]) + channels[b] +
                          static_cast<float>(factor * pixel.snow[b]);
        channels[b] = std::max(sum, 0.0F);
    }
}

template <float PixelResult::SeenSurface::*id>
void fill_mattes(const PixelResult& pixel, std::span<float> channels) {
    std::vector<Matte> mattes;
    for (const PixelResult::SeenSurface& surface : pixel.visible_surfaces)
        add_matte(surface.*id, surface.fraction, mattes);
    store_mattes(mattes, channels);
}

/// Leaves the channels unchanged: SensorPass fills them when the whole image is complete.
void keep(const PixelResult&, std::span<float>) {}

/// How a layer is filled from a pixel.
struct LayerFill {
    Layer layer;
    void (*fill)(const PixelResult& pixel, std::span<float> channels);
};

/// The fills of all layers; omitting a layer is a compile-time error.
constexpr std::array<LayerFill, k_layer_count> k_fills{{
    {Layer::total, fill_total},
    {Layer::direct, fill_radiance<&PixelResult::direct>},
    {Layer::forward, fill_radiance<&PixelResult::forward>},
    {Layer::backscatter, fill_radiance<&PixelResult::backscatter>},
    {Layer::backscatter_first, fill_radiance<&PixelResult::backscatter_first>},
    {Layer::multiple, fill_multiple},
    {Layer::multiple_volume, fill_radiance<&PixelResult::multiple_volume>},
    {Layer::multiple_surface, fill_radiance<&PixelResult::multiple_surface>},
    {Layer::snow, fill_radiance<&PixelResult::snow>},
    {Layer::error, fill<&PixelResult::error>},
    {Layer::irradiance, fill<&PixelResult::irradiance>},
    {Layer::exitance, fill<&PixelResult::exitance>},
    {Layer::lit, fill<&PixelResult::lit>},
    {Layer::clean, fill_radiance<&PixelResult::clean>},
    {Layer::transmittance, fill<&PixelResult::transmittance>},
    {Layer::albedo, fill_from_hit<&SurfaceHit::reflectance>},
    {Layer::depth, fill<&PixelResult::depth_z>},
    {Layer::range, fill<&PixelResult::range>},
    {Layer::path, fill<&PixelResult::path>},
    {Layer::normal, fill_from_hit<&SurfaceHit::normal>},
    {Layer::position, fill_from_hit<&SurfaceHit::position>},
    {Layer::id, fill_from_hit<&SurfaceHit::object_id>},
    {Layer::material, fill_from_hit<&SurfaceHit::material_id>},
    {Layer::plume_optical_depth, fill<&PixelResult::plume_optical_depth>},
    {Layer::plume_opacity, fill<&PixelResult::plume_opacity>},
    {Layer::plume_range_50, fill<&PixelResult::plume_range_50>},
    {Layer::plume_range_10, fill<&PixelResult::plume_range_10>},
    {Layer::crypto_object, fill_mattes<&PixelResult::SeenSurface::object>},
    {Layer::crypto_material, fill_mattes<&PixelResult::SeenSurface::material>},
    {Layer::sensor, keep},
    {Layer::flow, fill<&PixelResult::flow>},
    {Layer::flow_back, fill<&PixelResult::flow_back>},
    {Layer::flow_occluded, fill<&PixelResult::flow_occluded>},
    {Layer::plume_flow, fill<&PixelResult::plume_flow>},
    {Layer::disparity, fill<&PixelResult::disparity>},
    {Layer::disparity_occluded, fill<&PixelResult::disparity_occluded>},
}};
static_assert(has_every_layer(k_fills));

/// The indices of the channels of the groups that `is_wanted` selects.
template <class Wanted>
std::vector<std::size_t> channels_where(const LayerPlan& plan, const Wanted& is_wanted) {
    std::vector<std::size_t> channels;
    for (const ChannelGroup& group : plan.groups())
        if (is_wanted(group))
            for (std::size_t i = 0; i < group.size; ++i) channels.push_back(group.first + i);
    return channels;
}

/// Calls `change(x, y, channels)` for every pixel of a film.
template <class Change>
void for_each_pixel(Film& film, const Change& change) {
    const PixelWindow& window = film.window();
    parallel_for(static_cast<std::size_t>(window.height()), [&](std::size_t line) {
        const int y = window.y0 + static_cast<int>(line);
        for (int x = window.x0; x < window.x1; ++x) change(x, y, film.pixel(x, y));
    });
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
    fill_total(pixel, total);
    store_colour(total, colour, channels);
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

void store_layer(const LayerFill& line, const PixelResult& pixel, const LayerPlan& plan,
                 std::span<float> channels) {
    if (!plan.has(line.layer)) return;
    const std::span<float> own = plan.channels(line.layer, channels);
    if (kind_of(line.layer).content == LayerContent::point && !pixel.has_hit)
        std::ranges::fill(own, 0.0F);
    else
        line.fill(pixel, own);
}

/// Recomputes the sums of layers whose terms the image contains, in the order of fill_total, after
/// the terms were averaged and rounded: so they are exact to the bit.
void restore_sums(const LayerPlan& plan, const BandColour& colour, std::span<float> channels) {
    const bool has_forward = plan.is_provided(Layer::forward);
    const bool has_snow = plan.is_provided(Layer::snow);
    const auto layer = [&](Layer which) { return plan.channels(which, channels); };
    std::array<float, k_max_bands> multiple{}, sums{};
    const std::span<float> more = std::span(multiple).first(plan.band_count());
    if (plan.has(Layer::multiple_volume) && plan.has(Layer::multiple_surface)) {
        std::ranges::copy(layer(Layer::multiple_volume), more.begin());
        add_channels(more, layer(Layer::multiple_surface));
        if (plan.has(Layer::multiple)) std::ranges::copy(more, layer(Layer::multiple).begin());
    } else if (plan.has(Layer::multiple)) {
        std::ranges::copy(layer(Layer::multiple), more.begin());
    } else if (plan.is_provided(Layer::multiple)) {
        return;
    }
    if (!plan.has(Layer::direct) || !plan.has(Layer::backscatter)) return;
    if (has_forward && !plan.has(Layer::forward)) return;
    if (has_snow && !plan.has(Layer::snow)) return;
    const std::span<float> total = std::span(sums).first(plan.band_count());
    std::ranges::copy(layer(Layer::direct), total.begin());
    if (has_forward) add_channels(total, layer(Layer::forward));
    add_channels(total, layer(Layer::backscatter));
    add_channels(total, more);
    if (has_snow) {
        add_channels(total, layer(Layer::snow));
        for (float& sum : total) sum = std::max(sum, 0.0F);
    }
    if (plan.has(Layer::total)) std::ranges::copy(total, layer(Layer::total).begin());
    store_colour(total, colour, channels);
}

}  // namespace

void PixelResult::reset(std::size_t lamp_count, std::size_t bands) {
    alpha = lit = depth_z = range = path = 0;
    plume_opacity = plume_range_50 = plume_range_10 = 0;
    pixel_factor = 1;
    has_hit = false;
    hit = {};
    constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
    flow = flow_back = plume_flow = disparity = {k_none, k_none};
    flow_occluded = disparity_occluded = k_none;
    // There are few bands, so that clearing band by band is faster than spectrum by spectrum.
    for (std::size_t b = 0; b < bands; ++b)
        for (Spectrum* const values :
             {&direct, &lamps_in_view, &forward, &backscatter, &backscatter_first, &multiple_volume,
              &multiple_surface, &snow, &error, &irradiance, &exitance, &clean, &transmittance,
              &plume_optical_depth})
            (*values)[b] = 0;
    lamps.assign(lamp_count, Spectrum{});
    orders.clear();
    reflections.clear();
    visible_surfaces.clear();
}

void PixelResult::dim(const Spectrum& factor) {
    for (Spectrum* const light : {&direct, &lamps_in_view, &forward, &backscatter, &multiple_volume,
                                  &multiple_surface, &snow, &error})
        *light *= factor;
    backscatter_first = {};
    for (std::vector<Spectrum>* const list : {&lamps, &orders, &reflections})
        for (Spectrum& light : *list) light *= factor;
}

InScatterParts in_scatter_parts(const LayerPlan& plan) {
    return {.lamps = plan.has_lamps(), .first_slab = plan.has(Layer::backscatter_first)};
}

void store_pixel(const PixelResult& pixel, const LayerPlan& plan, const BandColour& colour,
                 std::span<float> channels) {
    store_colour(pixel, plan.band_count(), colour, channels);
    channels[k_alpha] = static_cast<float>(pixel.alpha);
    for (const LayerFill& line : k_fills) store_layer(line, pixel, plan, channels);
    const auto store_light = [&](const Spectrum& radiance, std::span<float> own) {
        store(radiance, own, pixel.pixel_factor);
    };
    for (std::size_t j = 0; j < pixel.lamps.size(); ++j)
        store_light(pixel.lamps[j], plan.lamp_channels(j, channels));
    for (std::size_t order = 0; order < plan.order_count(); ++order) {
        store_light(pixel.orders[order], plan.order_channels(order, channels));
        store_light(pixel.reflections[order], plan.reflection_channels(order, channels));
    }
}

void store_truth(const PixelResult& pixel, const LayerPlan& plan, std::span<float> channels) {
    for (const LayerFill& line : k_fills)
        if (!is_of_exposure(kind_of(line.layer).content)) store_layer(line, pixel, plan, channels);
}

void merge_paths(const PixelResult& pixel, double weight, const LayerPlan& plan,
                 const BandColour& colour, std::span<float> channels) {
    std::vector<float> fresh(channels.size());
    store_pixel(pixel, plan, colour, fresh);
    for (const ChannelGroup& group : plan.groups())
        if (group.content == LayerContent::light || group.first == k_alpha)
            mix_channels(group.of(channels), group.of(fresh), weight);
    restore_sums(plan, colour, channels);
}

void store_forward_scatter(const PixelResult& pixel, const LayerPlan& plan,
                           const BandColour& colour, std::span<float> channels) {
    using Effect = LayerKind::ForwardScatter;
    store_colour(pixel, plan.band_count(), colour, channels);
    std::array<float, k_max_bands> added{};
    const std::span<float> more = std::span(added).first(plan.band_count());
    for (const LayerFill& line : k_fills) {
        const Effect effect = kind_of(line.layer).forward_scatter;
        if (effect == Effect::leaves || !plan.has(line.layer)) continue;
        const std::span<float> own = plan.channels(line.layer, channels);
        if (effect == Effect::replaces) {
            line.fill(pixel, own);
        } else {
            line.fill(pixel, more);
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

void take_bands(const Film& from, std::span<const std::size_t> bands, const LayerPlan& plan,
                Film& film) {
    std::vector<std::size_t> channels;
    for (const ChannelGroup& group : plan.groups())
        if (group.is_by_band && is_of_exposure(group.content))
            for (const std::size_t band : bands) channels.push_back(group.first + band);
    for_each_pixel(film, [&](int x, int y, std::span<float> own) {
        const std::span<const float> more = from.pixel(x, y);
        for (const std::size_t channel : channels) own[channel] = more[channel];
        for (const std::size_t channel : {k_red, k_green, k_blue}) own[channel] += more[channel];
        if (from.shows_lamp(x, y)) film.mark_lamp(x, y);
    });
}

void add_mirrored(const Film& mirrored, const LayerPlan& plan, const BandColour& colour,
                  Film& film) {
    const std::vector<std::size_t> channels = channels_where(
        plan, [](const ChannelGroup& group) { return group.content == LayerContent::light; });
    const std::vector<std::size_t> errors =
        channels_where(plan, [](const ChannelGroup& group) { return group.layer == Layer::error; });
    for_each_pixel(film, [&](int x, int y, std::span<float> own) {
        const std::span<const float> more = mirrored.pixel(x, y);
        if (more[k_alpha] == 0) return;
        for (const std::size_t channel : channels) own[channel] += more[channel];
        for (const std::size_t channel : errors)
            own[channel] = std::hypot(own[channel], more[channel]);
        restore_sums(plan, colour, own);
        if (mirrored.shows_lamp(x, y)) film.mark_lamp(x, y);
    });
}

ExposureMean::ExposureMean(const LayerPlan& plan, const BandColour& colour, Errors errors,
                           Film& mean)
    : plan_(plan), colour_(colour), errors_(errors), mean_(mean) {
    channels_ = channels_where(plan, [](const ChannelGroup& group) {
        return is_of_exposure(group.content) && group.content != LayerContent::matte &&
               group.layer != Layer::error && group.layer != Layer::transmittance;
    });
    fractions_.assign(static_cast<std::size_t>(mean.window().height()), 0.0F);
    if (plan.has(Layer::transmittance))
        on_surface_.assign(mean.window().width(), mean.window().height());
}

void ExposureMean::add(const Film& part, const RowFraction& fraction) {
    const PixelWindow& window = part.window();
    const int x0 = mean_.window().x0, y0 = mean_.window().y0;
    parallel_for(static_cast<std::size_t>(window.height()), [&](std::size_t line) {
        const int y = window.y0 + static_cast<int>(line);
        const auto weight = static_cast<float>(fraction(y));
        if (weight == 0) return;
        float& so_far = fractions_[static_cast<std::size_t>(y - y0)];
        so_far += weight;
        for (int x = window.x0; x < window.x1; ++x) {
            if (part.shows_lamp(x, y)) mean_.mark_lamp(x, y);
            add_pixel(part.pixel(x, y), weight, so_far, mean_.pixel(x, y));
            if (!on_surface_.empty())
                add_transmittance(part.pixel(x, y), weight, mean_.pixel(x, y),
                                  on_surface_(x - x0, y - y0));
        }
    });
}

// The mean is updated incrementally, so that a value that is equal in all parts stays the same to
// the bit.
void ExposureMean::add_pixel(std::span<const float> part, float fraction, float fraction_so_far,
                             std::span<float> mean) const {
    const float weight = fraction / fraction_so_far;
    for (const std::size_t channel : channels_)
        mean[channel] += weight * (part[channel] - mean[channel]);
    for (const Layer matte : {Layer::crypto_object, Layer::crypto_material}) {
        if (!plan_.has(matte)) continue;
        const auto first = static_cast<std::size_t>(plan_.first_channel(matte));
        mix_mattes(part.subspan(first, k_matte_values), static_cast<double>(weight),
                   mean.subspan(first, k_matte_values));
    }
    if (!plan_.has(Layer::error)) return;
    const auto first = static_cast<std::size_t>(plan_.first_channel(Layer::error));
    for (std::size_t b = 0; b < plan_.band_count(); ++b) {
        const float error = fraction * part[first + b];
        mean[first + b] += errors_ == Errors::independent ? error * error : error;
    }
}

void ExposureMean::add_transmittance(std::span<const float> part, float fraction,
                                     std::span<float> mean, float& on_surface) const {
    const auto first = static_cast<std::size_t>(plan_.first_channel(Layer::transmittance));
    const std::span<const float> transmittance = part.subspan(first, plan_.band_count());
    if (std::ranges::none_of(transmittance, [](float value) { return value > 0; })) return;
    on_surface += fraction;
    for (std::size_t b = 0; b < transmittance.size(); ++b)
        mean[first + b] += fraction / on_surface * (transmittance[b] - mean[first + b]);
}

void ExposureMean::finish() {
    for_each_pixel(mean_, [&](int, int, std::span<float> pixel) {
        if (plan_.has(Layer::error) && errors_ == Errors::independent)
            for (float& value : plan_.channels(Layer::error, pixel)) value = std::sqrt(value);
        restore_sums(plan_, colour_, pixel);
    });
}

}  // namespace uw
