#include "core/texture.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/image_reader.h"

namespace uw {
namespace {

/// The texel that `index`, which may lie outside the image, stands for.
int wrapped(double index, int size, TextureWrap wrap) {
    const double n = size;
    if (wrap == TextureWrap::clamp) return static_cast<int>(std::clamp(index, 0.0, n - 1));
    const double period = wrap == TextureWrap::repeat ? n : 2 * n;
    double within = index - period * std::floor(index / period);
    if (within >= period) within = 0;  // rounding of the floor above, for huge indices
    return static_cast<int>(within < n ? within : period - 1 - within);
}

}  // namespace

Texture::Texture(const PixelImage& image) : width_(image.width), height_(image.height) {
    if (width_ < 1 || height_ < 1 || image.channels < 1) {
        throw std::invalid_argument("a texture needs at least one pixel");
    }
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::size_t count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    rgb_.resize(3 * count);
    for (std::size_t pixel = 0; pixel < count; ++pixel) {
        for (std::size_t color = 0; color < 3; ++color) {
            const float encoded = image.pixels[pixel * channels + (channels < 3 ? 0 : color)];
            rgb_[3 * pixel + color] = static_cast<float>(linear_from_srgb(encoded));
        }
    }
}

Rgb Texture::texel(int x, int y) const {
    const auto at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                         static_cast<std::size_t>(x));
    return {rgb_[at], rgb_[at + 1], rgb_[at + 2]};
}

Rgb Texture::sample(double u, double v, const TextureLookup& lookup) const {
    const double x = u * width_, y = v * height_;
    if (lookup.filter == TextureFilter::nearest) {
        return texel(wrapped(std::floor(x), width_, lookup.wrap_u),
                     wrapped(std::floor(y), height_, lookup.wrap_v));
    }
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
    const double fx = x - 0.5 - left, fy = y - 0.5 - top;
    const int x0 = wrapped(left, width_, lookup.wrap_u);
    const int x1 = wrapped(left + 1, width_, lookup.wrap_u);
    const int y0 = wrapped(top, height_, lookup.wrap_v);
    const int y1 = wrapped(top + 1, height_, lookup.wrap_v);
    const Rgb a = texel(x0, y0), b = texel(x1, y0), c = texel(x0, y1), d = texel(x1, y1);
    Rgb result{};
    for (std::size_t i = 0; i < 3; ++i) {
        result[i] = (1 - fy) * ((1 - fx) * a[i] + fx * b[i]) + fy * ((1 - fx) * c[i] + fx * d[i]);
    }
    return result;
}

}  // namespace uw
