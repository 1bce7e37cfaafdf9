#include "core/meshes/texture.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/stop.h"
#include "core/image/image_reader.h"

namespace uw {
namespace {

/// The texel to which `index`, which may lie outside the image, is wrapped.
int wrapped(double index, int size, TextureWrap wrap) {
    const double n = size;
    if (wrap == TextureWrap::clamp) return static_cast<int>(std::clamp(index, 0.0, n - 1));
    const double period = wrap == TextureWrap::repeat ? n : 2 * n;
    double within = index - period * std::floor(index / period);
    if (within >= period) within = 0;  // rounding of the floor above, for huge indices
    return static_cast<int>(within < n ? within : period - 1 - within);
}

}  // namespace

Texture::Texture(const PixelImage& image, TextureEncoding encoding, bool keep_alpha)
    : width_(image.width), height_(image.height) {
    if (width_ < 1 || height_ < 1 || image.channels < 1) {
        throw std::invalid_argument("a texture needs at least one pixel");
    }
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::size_t count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    rgb_.resize(3 * count);
    for (std::size_t pixel = 0; pixel < count; ++pixel) {
        throw_if_stopped();
        for (std::size_t color = 0; color < 3; ++color) {
            const float encoded = image.pixels[pixel * channels + (channels < 3 ? 0 : color)];
            rgb_[3 * pixel + color] = encoding == TextureEncoding::linear
                                          ? encoded
                                          : static_cast<float>(linear_from_srgb(encoded));
        }
    }
    if (!keep_alpha || (channels != 2 && channels != 4)) return;
    alpha_.resize(count);
    for (std::size_t pixel = 0; pixel < count; ++pixel) {
        alpha_[pixel] = image.pixels[(pixel + 1) * channels - 1];
    }
}

Texture::Footprint Texture::footprint(double u, double v, const TextureLookup& lookup) const {
    const auto place = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    };
    const double x = u * width_, y = v * height_;
    if (lookup.filter == TextureFilter::nearest) {
        return {{place(wrapped(std::floor(x), width_, lookup.wrap_u),
                       wrapped(std::floor(y), height_, lookup.wrap_v))},
                {1.0},
                1};
    }
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
    const double fx = x - 0.5 - left, fy = y - 0.5 - top;
    const int x0 = wrapped(left, width_, lookup.wrap_u);
    const int x1 = wrapped(left + 1, width_, lookup.wrap_u);
    const int y0 = wrapped(top, height_, lookup.wrap_v);
    const int y1 = wrapped(top + 1, height_, lookup.wrap_v);
    return {{place(x0, y0), place(x1, y0), place(x0, y1), place(x1, y1)},
            {(1 - fy) * (1 - fx), (1 - fy) * fx, fy * (1 - fx), fy * fx},
            4};
}

Rgb Texture::sample(double u, double v, const TextureLookup& lookup) const {
    const Footprint around = footprint(u, v, lookup);
    Rgb result{};
    for (std::size_t k = 0; k < around.count; ++k) {
        for (std::size_t i = 0; i < 3; ++i) {
            result[i] += around.weights[k] * rgb_[3 * around.texels[k] + i];
        }
    }
    return result;
}

double Texture::sample_alpha(double u, double v, const TextureLookup& lookup) const {
    if (alpha_.empty()) return 1;
    const Footprint around = footprint(u, v, lookup);
    double result = 0;
    for (std::size_t k = 0; k < around.count; ++k) {
        result += around.weights[k] * alpha_[around.texels[k]];
    }
    return result;
}

}  // namespace uw
