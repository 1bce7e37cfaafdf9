#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/colour/rgb.h"

namespace uw {

struct PixelImage;

enum class TextureFilter { nearest, linear };
enum class TextureWrap { repeat, clamp, mirror };

/// How a material samples a texture.
struct TextureLookup {
    TextureFilter filter = TextureFilter::linear;
    TextureWrap wrap_u = TextureWrap::repeat;
    TextureWrap wrap_v = TextureWrap::repeat;
};

/// How an image encodes its values.
enum class TextureEncoding { srgb, linear };

/// A linear RGB image; immutable, shared by materials, thread safe.
class Texture {
  public:
    /// Decodes sRGB code values of colours (glTF 2.0, 3.9.2); `linear` values, as in normal maps,
    /// are used as they are. Grey images fill all three channels; alpha, which is always linear, is
    /// dropped unless `keep_alpha`. Throws std::invalid_argument for an image without pixels.
    explicit Texture(const PixelImage& image, TextureEncoding encoding = TextureEncoding::srgb,
                     bool keep_alpha = false);

    int width() const { return width_; }
    int height() const { return height_; }

    /// Linear RGB at (u, v): (0, 0) is the outer corner of the top left texel, (1, 1) that of the
    /// bottom right one (glTF 2.0, 3.6.2). `linear` interpolates between texel centres in linear
    /// light.
    Rgb sample(double u, double v, const TextureLookup& lookup) const;
    /// The same for alpha, if kept; else 1.
    double sample_alpha(double u, double v, const TextureLookup& lookup) const;

  private:
    /// The texels around a point and their weights; for `nearest`, one.
    struct Footprint {
        std::array<std::size_t, 4> texels{};
        std::array<double, 4> weights{};
        std::size_t count = 0;
    };
    Footprint footprint(double u, double v, const TextureLookup& lookup) const;

    int width_ = 0, height_ = 0;
    std::vector<float> rgb_;    // row-major, top row first
    std::vector<float> alpha_;  // likewise; empty: 1 everywhere
};

/// A texture as one material uses it.
struct TextureUse {
    std::shared_ptr<const Texture> texture;  // null: none
    TextureLookup lookup;
    std::size_t uv_set = 0;  // 0 or 1
    /// KHR_texture_transform: u' = a[0] u + a[1] v + a[2], v' = a[3] u + a[4] v + a[5].
    std::array<double, 6> transform{1, 0, 0, 0, 1, 0};

    explicit operator bool() const { return texture != nullptr; }
    Rgb sample(double u, double v) const {
        return texture->sample(moved_u(u, v), moved_v(u, v), lookup);
    }
    double sample_alpha(double u, double v) const {
        return texture->sample_alpha(moved_u(u, v), moved_v(u, v), lookup);
    }

  private:
    double moved_u(double u, double v) const {
        return transform[0] * u + transform[1] * v + transform[2];
    }
    double moved_v(double u, double v) const {
        return transform[3] * u + transform[4] * v + transform[5];
    }
};

}  // namespace uw
