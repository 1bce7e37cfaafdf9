#include "core/image/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/available_memory.h"
#include "core/base/error.h"

namespace uw {

Film::Film(int width, int height, const PixelWindow& window, std::vector<std::string> channel_names)
    : width_(width), height_(height), window_(window), channel_names_(std::move(channel_names)) {
    if (window.x0 < 0 || window.y0 < 0 || window.x0 >= window.x1 || window.y0 >= window.y1 ||
        window.x1 > width || window.y1 > height) {
        throw UsageError(fmt::format(
            "--crop {},{},{},{}: not a part of the image; columns run from 0 to {}, rows from 0 "
            "to {}, and x0 < x1, y0 < y1",
            window.x0, window.y0, window.x1, window.y1, width, height));
    }
    // With what rendering and writing it take besides: measured as a seventh of its own size, and
    // some tens of megabytes for lamps and surfaces of most scenes.
    constexpr double k_with_writing = 1.2, k_min_besides = 5e7;
    const double bytes = k_with_writing * 4.0 * window.width() * window.height() *
                             static_cast<double>(channel_names_.size()) +
                         k_min_besides;
    require_memory(bytes,
                   fmt::format("camera.resolution: {} x {} pixels of {} channels need",
                               window.width(), window.height(), channel_names_.size()),
                   "ask for fewer --layers, a --crop or a smaller --size");
    values_.assign(window.width() * static_cast<int>(channel_names_.size()), window.height());
    shows_lamp_.assign(window.width(), window.height());
}

Film cropped(const Film& film, const PixelWindow& window) {
    Film part(film.width(), film.height(), window, film.channel_names());
    for (int y = window.y0; y < window.y1; ++y) {
        throw_if_stopped();
        for (int x = window.x0; x < window.x1; ++x) {
            std::ranges::copy(film.pixel(x, y), part.pixel(x, y).begin());
            if (film.shows_lamp(x, y)) part.mark_lamp(x, y);
        }
    }
    return part;
}

Film with_channels(const Film& film, const std::vector<std::string>& channel_names,
                   const PixelWindow& window) {
    std::vector<std::size_t> sources;
    for (const std::string& name : channel_names)
        sources.push_back(static_cast<std::size_t>(std::ranges::find(film.channel_names(), name) -
                                                   film.channel_names().begin()));
    Film part(film.width(), film.height(), window, channel_names);
    for (int y = window.y0; y < window.y1; ++y) {
        throw_if_stopped();
        for (int x = window.x0; x < window.x1; ++x) {
            const std::span<const float> from = film.pixel(x, y);
            const std::span<float> to = part.pixel(x, y);
            for (std::size_t i = 0; i < sources.size(); ++i) to[i] = from[sources[i]];
            if (film.shows_lamp(x, y)) part.mark_lamp(x, y);
        }
    }
    return part;
}

}  // namespace uw
