#pragma once

#include <vector>

#include "core/rgb.h"

namespace uw {

struct PixelImage;

enum class TextureFilter { nearest, linear };
enum class TextureWrap { repeat, clamp, mirror };

/// How a material looks a texture up.
struct TextureLookup {
    TextureFilter filter = TextureFilter::linear;
    TextureWrap wrap_u = TextureWrap::repeat;
    TextureWrap wrap_v = TextureWrap::repeat;
};

/// A base colour image in linear RGB; immutable, shared by materials, thread safe.
class Texture {
  public:
    /// Decodes sRGB code values (glTF 2.0, 3.9.2). Grey images fill all three colours; alpha is
    /// ignored. Throws std::invalid_argument for an image without pixels.
    explicit Texture(const PixelImage& srgb_encoded);

    int width() const { return width_; }
    int height() const { return height_; }

    /// Linear RGB at (u, v): (0, 0) is the outer corner of the top left texel, (1, 1) that of the
    /// bottom right one (glTF 2.0, 3.6.2). `linear` interpolates between texel centres in linear
    /// light.
    Rgb sample(double u, double v, const TextureLookup& lookup) const;

  private:
    Rgb texel(int x, int y) const;

    int width_ = 0, height_ = 0;
    std::vector<float> rgb_;  // row-major, top row first
};

}  // namespace uw
