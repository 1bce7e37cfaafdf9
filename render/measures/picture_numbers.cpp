#include "render/measures/picture_numbers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/measures/pixel_values.h"

namespace uw {
namespace {

double ratio_of(double signal, double backscatter) {
    if (backscatter > 0) return signal / backscatter;
    return signal > 0 ? std::numeric_limits<double>::infinity() : 0;
}

double contrast_of(std::span<double> values) {
    const double dark = mean_between(values, 0.05, 0.25), bright = mean_between(values, 0.75, 0.95);
    return bright + dark > 0 ? (bright - dark) / (bright + dark) : 0;
}

/// `seen`: the irradiance where there is a surface.
Evenness evenness_of(std::vector<double> seen) {
    Evenness even;
    even.pixels = seen.size();
    if (seen.empty()) return even;
    even.mean = mean_of(seen);
    even.least = *std::ranges::min_element(seen);
    even.greatest = *std::ranges::max_element(seen);
    even.percentile5 = percentile(seen, 0.05);
    even.median = percentile(seen, 0.5);
    even.percentile95 = percentile(seen, 0.95);
    if (even.mean > 0) {
        even.least_to_mean = even.least / even.mean;
        even.percentile5_to_mean = even.percentile5 / even.mean;
    }
    return even;
}

}  // namespace

PictureLayers picture_layers(const Film& film, const LayerPlan& plan) {
    PictureLayers picture{
        film.window().width(), film.window().height(), plan.band_count(), {}, {}, {}, {}, {}};
    picture.signal =
        layer_planes(film, plan, {Layer::direct, Layer::forward, Layer::multiple_surface});
    picture.backscatter = layer_planes(film, plan, {Layer::backscatter, Layer::multiple_volume});
    picture.clean = layer_planes(film, plan, {Layer::clean});
    picture.irradiance = layer_planes(film, plan, {Layer::irradiance});
    picture.albedo = layer_planes(film, plan, {Layer::albedo});
    return picture;
}

std::vector<std::size_t> pixels_within(const PixelWindow& part, int width) {
    std::vector<std::size_t> pixels;
    for (int y = part.y0; y < part.y1; ++y)
        for (int x = part.x0; x < part.x1; ++x)
            pixels.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(x));
    return pixels;
}

PictureNumbers measure_picture(const PictureLayers& picture, const PixelWindow& part,
                               double ratio) {
    return measure_picture(picture, pixels_within(part, picture.width), ratio);
}

PictureNumbers measure_picture(const PictureLayers& picture, std::span<const std::size_t> pixels,
                               double ratio) {
    const GreyLayers signal(picture.signal, picture.bands);
    const GreyLayers backscatter(picture.backscatter, picture.bands);
    const GreyLayers clean(picture.clean, picture.bands);
    const GreyLayers irradiance(picture.irradiance, picture.bands);
    const GreyLayers albedo(picture.albedo, picture.bands);
    std::vector<double> totals, signals, scattered, cleans, lit;
    std::size_t above = 0;
    for (const std::size_t pixel : pixels) {
        signals.push_back(signal.at(pixel));
        scattered.push_back(backscatter.at(pixel));
        totals.push_back(signals.back() + scattered.back());
        above += signals.back() > 0 && signals.back() >= ratio * scattered.back() ? 1U : 0U;
        cleans.push_back(clean.at(pixel));
        const double light = irradiance.at(pixel);
        if (light > 0 || albedo.at(pixel) > 0) lit.push_back(light);
    }
    PictureNumbers numbers;
    numbers.signal = mean_of(signals);
    numbers.backscatter = mean_of(scattered);
    numbers.signal_to_backscatter = ratio_of(numbers.signal, numbers.backscatter);
    numbers.share_above = static_cast<double>(above) / static_cast<double>(totals.size());
    numbers.contrast = contrast_of(totals);
    if (!clean.empty()) {
        const double without_water = mean_of(cleans);
        if (without_water > 0) numbers.lost_to_water = 1 - numbers.signal / without_water;
        numbers.clean_contrast = contrast_of(cleans);
    }
    if (!irradiance.empty()) numbers.evenness = evenness_of(std::move(lit));
    return numbers;
}

std::optional<PixelWindow> patterned_part(const PictureLayers& picture, int side) {
    const GreyLayers albedo(picture.albedo, picture.bands);
    const int width = picture.width, height = picture.height;
    if (albedo.empty() || side < 2 || side > std::min(width, height)) return std::nullopt;
    // Sums of the values and of their squares over all pixels above and to the left.
    const auto columns = static_cast<std::size_t>(width) + 1;
    std::vector<double> sums(columns * (static_cast<std::size_t>(height) + 1)), squares = sums;
    const auto at = [columns](int x, int y) {
        return static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x);
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double value = albedo.at(static_cast<std::size_t>(y) * (columns - 1) +
                                           static_cast<std::size_t>(x));
            for (auto [table, term] : {std::pair{&sums, value}, std::pair{&squares, value * value}})
                (*table)[at(x + 1, y + 1)] =
                    term + (*table)[at(x, y + 1)] + (*table)[at(x + 1, y)] - (*table)[at(x, y)];
        }
    const auto sum_within = [&](const std::vector<double>& table, int x, int y) {
        return table[at(x + side, y + side)] - table[at(x, y + side)] - table[at(x + side, y)] +
               table[at(x, y)];
    };
    // Of equal surfaces it is 0 but for rounding, which is far below this; no surface that anyone
    // would call patterned varies so little.
    constexpr double k_least_deviation = 0.01;
    double most = k_least_deviation * k_least_deviation;
    std::optional<PixelWindow> best;
    const double count = static_cast<double>(side) * side;
    for (int y = 0; y + side <= height; ++y)
        for (int x = 0; x + side <= width; ++x) {
            const double mean = sum_within(sums, x, y) / count;
            const double variance = sum_within(squares, x, y) / count - mean * mean;
            if (variance <= most) continue;
            most = variance;
            best = PixelWindow{x, y, x + side, y + side};
        }
    return best;
}

}  // namespace uw
