#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/grid2d.h"

namespace uw {

/// A rectangle of pixels, columns x0 to x1 - 1 and rows y0 to y1 - 1, in the full image.
struct PixelWindow {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
    friend bool operator==(const PixelWindow&, const PixelWindow&) = default;
};

/// The pixels of both; of negative width or height if there are none.
inline PixelWindow intersection(const PixelWindow& a, const PixelWindow& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

/// Channel indices, in every film, of the colour and coverage that previews show.
enum FilmChannel : std::size_t { k_red = 0, k_green = 1, k_blue = 2, k_alpha = 3 };

/// An image with any number of 32-bit float channels, of which only a window is stored. All values
/// are initially 0. A single allocation of 4 bytes * channels * pixels of the window, channels
/// interleaved. Different pixels may be written from different threads.
class Film {
  public:
    /// `channel_names` begins with R, G, B, A. Throws UsageError if the window is empty or extends
    /// beyond the image, and as require_memory.
    Film(int width, int height, const PixelWindow& window, std::vector<std::string> channel_names);

    int width() const { return width_; }
    int height() const { return height_; }
    const PixelWindow& window() const { return window_; }
    const std::vector<std::string>& channel_names() const { return channel_names_; }

    /// The channels of one pixel. x, y are coordinates in the full image and lie within the window.
    std::span<float> pixel(int x, int y) {
        return values_.row(y - window_.y0).subspan(first_channel(x), channel_names_.size());
    }
    std::span<const float> pixel(int x, int y) const {
        return values_.row(y - window_.y0).subspan(first_channel(x), channel_names_.size());
    }
    /// Marks a pixel in which a lamp itself is seen: the automatic exposure leaves it out.
    void mark_lamp(int x, int y) { shows_lamp_(x - window_.x0, y - window_.y0) = 1; }
    bool shows_lamp(int x, int y) const { return shows_lamp_(x - window_.x0, y - window_.y0) != 0; }
    /// All values of the window: row by row, pixel by pixel, channel by channel.
    std::span<const float> values() const { return values_.values(); }
    /// Resets all values to 0, and no pixel is marked.
    void clear() {
        values_.assign(values_.width(), values_.height());
        shows_lamp_.assign(shows_lamp_.width(), shows_lamp_.height());
    }

  private:
    // The index of the first channel of column x within a row.
    std::size_t first_channel(int x) const {
        return static_cast<std::size_t>(x - window_.x0) * channel_names_.size();
    }

    int width_;
    int height_;
    PixelWindow window_;
    std::vector<std::string> channel_names_;
    Grid2D<float> values_;  // a pixel's channels are contiguous
    Grid2D<std::uint8_t> shows_lamp_;
};

/// The part of `film` within `window`. Throws as Film's constructor.
Film cropped(const Film& film, const PixelWindow& window);

/// The part of `film` within `window` with these of its channels alone. Precondition: it has them.
/// Throws as Film's constructor.
Film with_channels(const Film& film, const std::vector<std::string>& channel_names,
                   const PixelWindow& window);

}  // namespace uw
