#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace uw {

/// Linear red, green, blue of a diffuse reflectance, 0..1 (sRGB primaries, as in files).
using Rgb = std::array<double, 3>;

/// IEC 61966-2-1: the sRGB code value in 0..1 as linear light.
inline double linear_from_srgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

struct PixelImage;
class PartialImage;

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

/// The parallelogram over which a look-up averages, centred at the point: its sides as (u, v).
/// Zero: the point alone.
struct TextureSpread {
    std::array<double, 2> across{}, down{};
};

/// A linear RGB image; immutable, shared by materials, thread safe. A mip map: images of half its
/// size, of a quarter, and so on, each averaged from the one before, serve look-ups over many
/// texels.
class Texture {
  public:
    /// Decodes sRGB code values of colours (glTF 2.0, 3.9.2); `linear` values, as in normal maps,
    /// and those of linear images are used as they are. Grey images fill all three channels; alpha,
    /// which is always linear, is dropped unless `keep_alpha`. Throws std::invalid_argument for an
    /// image without pixels.
    explicit Texture(const PixelImage& image, TextureEncoding encoding = TextureEncoding::srgb,
                     bool keep_alpha = false);

    /// The same for an image that is read in parts: levels of at most `max_texels` are made here
    /// and kept in memory; finer ones are looked up in the file. Throws InputError if it cannot be
    /// read; messages call it `name`.
    Texture(std::shared_ptr<const PartialImage> image, const std::string& name,
            TextureEncoding encoding, bool keep_alpha,
            std::int64_t max_texels = std::int64_t{1} << 23);

    /// Linear red, green and blue, row by row. Precondition: all of it is in memory.
    std::span<const float> rgb() const { return levels_.front().rgb; }
    int width() const { return levels_.front().width; }
    int height() const { return levels_.front().height; }

    /// Linear RGB at (u, v): (0, 0) is the outer corner of the top left texel, (1, 1) that of the
    /// bottom right one (glTF 2.0, 3.6.2). `linear` interpolates between texel centres in linear
    /// light.
    Rgb sample(double u, double v, const TextureLookup& lookup) const;
    /// The mean over a parallelogram, by up to 16 look-ups along its longer side in the images
    /// whose texels are about as wide as its shorter one (or a 16th of the longer). Within a texel
    /// it is the look-up at the point.
    Rgb sample(double u, double v, const TextureLookup& lookup, const TextureSpread& spread) const;
    /// The same for alpha, if kept; else 1.
    double sample_alpha(double u, double v, const TextureLookup& lookup) const;

  private:
    friend class TextureGradient;

    struct Level {
        int width = 0, height = 0;
        /// How many of its texels the texture covers: all, except the ends of the last row and
        /// column where pixels of a file were averaged in pairs.
        double columns = 0, rows = 0;
        std::vector<float> rgb;  // row-major, top row first; empty: in the file
        int halvings = 0;        // of those in the file
    };
    /// The texels around a point and their weights; for `nearest`, one.
    struct Footprint {
        std::array<std::size_t, 4> texels{};
        std::array<double, 4> weights{};
        std::size_t count = 0;
    };
    static Footprint footprint(const Level& level, double u, double v, const TextureLookup& lookup);
    Rgb sample(const Level& level, double u, double v, const TextureLookup& lookup) const;
    /// Calls `look_up(level, u, v, lookup, weight)` for the terms whose weighted sum is a look-up
    /// over a parallelogram.
    template <class LookUp>
    void visit(double u, double v, const TextureLookup& lookup, const TextureSpread& spread,
               const LookUp& look_up) const;
    double decoded(float encoded) const;
    /// Texels of a level that is in the file, `columns` times `rows` from (x, y) on: means over the
    /// pixels that they represent.
    void texels_of_file(const Level& level, int x, int y, int columns, int rows,
                        std::span<Rgb> texels) const;
    double alpha_of_file(std::size_t place) const;
    void sum_lines(Level& level) const;
    [[noreturn]] void fail_to_read() const;
    /// Half as wide and high, rounded up.
    static Level halved(const Level& level);

    std::vector<Level> levels_;  // the image itself, and then always halves, to a single texel
    std::vector<float> alpha_;   // of the image; empty: 1 everywhere, or in the file
    std::shared_ptr<const PartialImage> file_;  // null: all is in memory
    std::string name_;                          // of that file, for messages
    bool is_encoded_ = false, has_alpha_in_file_ = false;
};

/// Accumulates the derivatives of a number by the texels of a texture from those by the results of
/// look-ups: the transpose of Texture::sample. For one thread.
class TextureGradient {
  public:
    /// `texture` must outlive it and be completely in memory.
    explicit TextureGradient(const Texture& texture);

    const Texture& texture() const { return *texture_; }
    /// The number changes by these weights per unit of red, green and blue of that look-up.
    void add(double u, double v, const TextureLookup& lookup, const TextureSpread& spread,
             const Rgb& weights);
    /// By texel, [(row * width + column) * 3 + colour].
    std::vector<double> by_texel() const;

  private:
    const Texture* texture_;
    std::vector<std::vector<double>> levels_;  // as the texture's
};

/// The texture in a file, read as a whole or in parts. Throws as read_image and open_partial_image.
std::shared_ptr<const Texture> read_texture(const std::filesystem::path& file,
                                            TextureEncoding encoding = TextureEncoding::srgb,
                                            bool keep_alpha = false);

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
    /// Over a parallelogram that is given before the transform.
    Rgb sample(double u, double v, const TextureSpread& spread) const {
        return texture->sample(moved_u(u, v), moved_v(u, v), lookup,
                               {turned(spread.across), turned(spread.down)});
    }
    /// The transpose of that.
    void add_to(TextureGradient& gradient, double u, double v, const TextureSpread& spread,
                const Rgb& weights) const {
        gradient.add(moved_u(u, v), moved_v(u, v), lookup,
                     {turned(spread.across), turned(spread.down)}, weights);
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
    std::array<double, 2> turned(const std::array<double, 2>& d) const {
        return {transform[0] * d[0] + transform[1] * d[1],
                transform[3] * d[0] + transform[4] * d[1]};
    }
};

}  // namespace uw
