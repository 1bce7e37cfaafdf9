#include "core/image/exr_options.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/image/layers.h"

namespace uw {
namespace {

// Half floats below 2^-14 are rounded by up to 2^-25, which is 1.2e-4 of this.
constexpr double k_least_mean = 0x1p-12;
// What is rounded to an infinite half float: this and more. The largest finite one is 65504.
constexpr float k_infinite_half = 65520.0F;
constexpr float k_infinity = std::numeric_limits<float>::infinity();

std::vector<std::size_t> light_channels(const Film& film) {
    std::vector<std::size_t> channels;
    for (std::size_t c = 0; c < film.channel_names().size(); ++c)
        if (is_light(film.channel_names()[c])) channels.push_back(c);
    return channels;
}

/// Whether there is no light beside that of the image itself.
bool has_no_more_light(std::span<const std::string> channel_names) {
    return std::ranges::all_of(channel_names, [](const std::string& name) {
        return !is_light(name) || is_image_channel(name);
    });
}

}  // namespace

HalfLoss half_loss(const Film& film) {
    struct Line {
        std::vector<double> sums;
        std::size_t too_large = 0, pixels = 0;
    };
    const PixelWindow& window = film.window();
    const std::vector<std::size_t> channels = light_channels(film);
    std::vector<Line> lines(static_cast<std::size_t>(window.height()));
    parallel_for(lines.size(), [&](std::size_t i) {
        Line& line = lines[i];
        const int y = window.y0 + static_cast<int>(i);
        for (int x = window.x0; x < window.x1; ++x)
            if (film.pixel(x, y)[k_alpha] > 0) ++line.pixels;
        for (const std::size_t channel : channels) {
            double sum = 0;
            for (int x = window.x0; x < window.x1; ++x) {
                const float value = std::abs(film.pixel(x, y)[channel]);
                if (value >= k_infinite_half && value < k_infinity) ++line.too_large;
                sum += static_cast<double>(value);
            }
            line.sums.push_back(sum);
        }
    });
    HalfLoss loss;
    Line all{std::vector<double>(channels.size())};
    for (const Line& line : lines) {
        for (std::size_t c = 0; c < channels.size(); ++c) all.sums[c] += line.sums[c];
        all.pixels += line.pixels;
        loss.too_large += line.too_large;
    }
    const double least = k_least_mean * static_cast<double>(all.pixels);
    loss.too_dark = std::ranges::any_of(all.sums, [&](double s) { return s > 0 && s < least; });
    return loss;
}

std::vector<ExrChannel> exr_channels(const Film& film, ExrOptions::Precision precision) {
    using enum ExrOptions::Precision;
    bool is_half = precision == half;
    if (precision == automatic && has_no_more_light(film.channel_names()))
        is_half = half_loss(film).is_none();
    std::vector<ExrChannel> channels;
    for (const std::string& name : film.channel_names())
        channels.push_back({name, is_half && is_light(name)});
    std::ranges::sort(channels, {}, &ExrChannel::name);
    return channels;
}

bool is_stored_with(ExrOptions::Precision precision, std::span<const ExrChannel> channels) {
    using enum ExrOptions::Precision;
    std::vector<std::string> names;
    for (const ExrChannel& channel : channels) names.push_back(channel.name);
    const auto matches = [&](bool is_half) {
        return std::ranges::all_of(channels, [&](const ExrChannel& c) {
            return c.is_half == (is_half && is_light(c.name));
        });
    };
    const bool may_be_half =
        precision == half || (precision == automatic && has_no_more_light(names));
    return (may_be_half && matches(true)) || (precision != half && matches(false));
}

}  // namespace uw
