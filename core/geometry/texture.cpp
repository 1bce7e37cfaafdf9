#include "core/geometry/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/image/image_file.h"
#include "core/image/image_formats.h"

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

Texture::Texture(const PixelImage& image, TextureEncoding encoding, bool keep_alpha) {
    if (image.width < 1 || image.height < 1 || image.channels < 1) {
        throw std::invalid_argument("a texture needs at least one pixel");
    }
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::size_t count =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    Level whole{image.width, image.height, static_cast<double>(image.width),
                static_cast<double>(image.height), std::vector<float>(3 * count)};
    for (std::size_t pixel = 0; pixel < count; ++pixel) {
        throw_if_stopped();
        for (std::size_t color = 0; color < 3; ++color) {
            const float encoded = image.pixels[pixel * channels + (channels < 3 ? 0 : color)];
            whole.rgb[3 * pixel + color] = encoding == TextureEncoding::linear || image.is_linear
                                               ? encoded
                                               : static_cast<float>(linear_from_srgb(encoded));
        }
    }
    levels_.push_back(std::move(whole));
    while (levels_.back().width > 1 || levels_.back().height > 1)
        levels_.push_back(halved(levels_.back()));
    if (!keep_alpha || (channels != 2 && channels != 4)) return;
    alpha_.resize(count);
    for (std::size_t pixel = 0; pixel < count; ++pixel) {
        alpha_[pixel] = image.pixels[(pixel + 1) * channels - 1];
    }
}

Texture::Texture(std::shared_ptr<const PartialImage> image, const std::string& name,
                 TextureEncoding encoding, bool keep_alpha, std::int64_t max_texels)
    : file_(std::move(image)),
      name_(name),
      is_encoded_(encoding == TextureEncoding::srgb && !file_->is_linear),
      has_alpha_in_file_(keep_alpha && (file_->channels == 2 || file_->channels == 4)) {
    for (int halvings = 0;; ++halvings) {
        const int step = 1 << halvings;
        Level level;
        level.width = (file_->width + step - 1) / step;
        level.height = (file_->height + step - 1) / step;
        level.columns = static_cast<double>(file_->width) / step;
        level.rows = static_cast<double>(file_->height) / step;
        level.halvings = halvings;
        const bool is_in_memory = std::int64_t{level.width} * level.height <= max_texels;
        if (is_in_memory) sum_lines(level);
        levels_.push_back(std::move(level));
        if (is_in_memory) break;
    }
    while (levels_.back().width > 1 || levels_.back().height > 1)
        levels_.push_back(halved(levels_.back()));
}

namespace {

/// linear_from_srgb of whole numbers of 16 bits, and so of 8.
const std::vector<float>& linear_of_16_bits() {
    static const std::vector<float> table = [] {
        std::vector<float> values;
        constexpr int k_max_code = 65535;
        for (int i = 0; i <= k_max_code; ++i)
            values.push_back(
                static_cast<float>(linear_from_srgb(static_cast<double>(i) / k_max_code)));
        return values;
    }();
    return table;
}

}  // namespace

double Texture::decoded(float encoded) const {
    const float value = encoded > 0 ? std::min(encoded, 1.0F) : 0.0F;
    if (!is_encoded_) return value;
    const std::vector<float>& table = linear_of_16_bits();
    const float rounded = 65535 * value + 0.5F;
    return double{table[static_cast<std::size_t>(rounded)]};
}

/// Fills a level with the means over squares of the file's pixels, line after line of them.
void Texture::sum_lines(Level& level) const {
    level.rgb.resize(3 * static_cast<std::size_t>(level.width) *
                     static_cast<std::size_t>(level.height));
    const int step = 1 << level.halvings;
    const auto channels = static_cast<std::size_t>(file_->channels);
    // A line from x0, where a texel begins, to x1.
    const auto add = [&](int y, int x0, int x1, const float* at) {
        const int begin = y / step * step;
        const int rows = std::min(begin + step, file_->height) - begin;
        float* sum = &level.rgb[3 * (static_cast<std::size_t>(y / step) *
                                         static_cast<std::size_t>(level.width) +
                                     static_cast<std::size_t>(x0 / step))];
        for (int x = x0; x < x1; x += step, sum += 3) {
            const int columns = std::min(step, file_->width - x);
            Rgb line{};
            for (int i = 0; i < columns; ++i, at += channels)
                for (std::size_t c = 0; c < 3; ++c) line[c] += decoded(at[channels < 3 ? 0 : c]);
            for (std::size_t c = 0; c < 3; ++c)
                sum[c] += static_cast<float>(line[c] / (rows * columns));
        }
    };
    const int block = std::max(step, 1024);  // of columns, for one thread
    const auto blocks = static_cast<std::size_t>((file_->width + block - 1) / block);
    const bool is_whole = file_->read_all([&](int y0, int y1, const float* values) {
        throw_if_stopped();
        parallel_for(blocks, [&](std::size_t i) {
            const int x0 = static_cast<int>(i) * block, x1 = std::min(x0 + block, file_->width);
            for (int y = y0; y < y1; ++y)
                add(y, x0, x1,
                    values + channels * (static_cast<std::size_t>(file_->width) *
                                             static_cast<std::size_t>(y - y0) +
                                         static_cast<std::size_t>(x0)));
        });
    });
    if (!is_whole)
        throw InputError(name_ + ": cannot read all of the image; it is damaged, save it again");
}

void Texture::fail_to_read() const {
    throw IoError(name_ +
                  ": cannot read the image any more; keep the file until the end of the run");
}

void Texture::texels_of_file(const Level& level, int x, int y, int columns, int rows,
                             std::span<Rgb> texels) const {
    const int step = 1 << level.halvings;
    const int x0 = x * step, y0 = y * step;
    const int x1 = std::min(x0 + columns * step, file_->width);
    const int y1 = std::min(y0 + rows * step, file_->height);
    const auto channels = static_cast<std::size_t>(file_->channels);
    std::vector<float> values(channels * static_cast<std::size_t>(x1 - x0) *
                              static_cast<std::size_t>(y1 - y0));
    if (!file_->read(x0, y0, x1, y1, values.data())) fail_to_read();
    std::ranges::fill(texels, Rgb{});
    const float* at = values.data();
    for (int j = y0; j < y1; ++j)
        for (int i = x0; i < x1; ++i, at += channels) {
            const int place = (j - y0) / step * columns + (i - x0) / step;
            Rgb& texel = texels[static_cast<std::size_t>(place)];
            for (std::size_t c = 0; c < 3; ++c) texel[c] += decoded(at[channels < 3 ? 0 : c]);
        }
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const int area = (std::min(x0 + (column + 1) * step, x1) - x0 - column * step) *
                             (std::min(y0 + (row + 1) * step, y1) - y0 - row * step);
            const int place = row * columns + column;
            for (double& value : texels[static_cast<std::size_t>(place)]) value /= area;
        }
}

double Texture::alpha_of_file(std::size_t place) const {
    const auto width = static_cast<std::size_t>(file_->width);
    const int x = static_cast<int>(place % width), y = static_cast<int>(place / width);
    std::array<float, 4> values{};
    if (!file_->read(x, y, x + 1, y + 1, values.data())) fail_to_read();
    return double{values.at(static_cast<std::size_t>(file_->channels) - 1)};
}

std::shared_ptr<const Texture> read_texture(const std::filesystem::path& file,
                                            TextureEncoding encoding, bool keep_alpha) {
    if (auto parts = open_partial_image(file))
        return std::make_shared<Texture>(std::move(parts), file.string(), encoding, keep_alpha);
    return std::make_shared<Texture>(read_image(file), encoding, keep_alpha);
}

namespace {

/// The texels that a texel of the next coarser level covers along a side, and their weights: the
/// outer ones may be covered in part.
struct HalvedTexel {
    int first = 0, count = 0;
    std::array<double, 3> fractions{};

    HalvedTexel(int texel, int size, int half) {
        const double width = static_cast<double>(size) / half;
        const double begin = texel * width, end = std::min(begin + width, double(size));
        first = static_cast<int>(begin);
        for (int i = first; i < end && count < 3; ++i)
            fractions[static_cast<std::size_t>(count++)] =
                (std::min(end, i + 1.0) - std::max(begin, double(i))) / width;
    }
};

}  // namespace

Texture::Level Texture::halved(const Level& level) {
    Level half;
    half.width = (level.width + 1) / 2;
    half.height = (level.height + 1) / 2;
    half.columns = level.columns * half.width / level.width;
    half.rows = level.rows * half.height / level.height;
    half.rgb.reserve(3 * static_cast<std::size_t>(half.width) *
                     static_cast<std::size_t>(half.height));
    std::vector<HalvedTexel> columns;
    columns.reserve(static_cast<std::size_t>(half.width));
    for (int x = 0; x < half.width; ++x) columns.emplace_back(x, level.width, half.width);
    for (int y = 0; y < half.height; ++y) {
        throw_if_stopped();
        const HalvedTexel rows(y, level.height, half.height);
        for (const HalvedTexel& column : columns) {
            Rgb sum{};
            for (int j = 0; j < rows.count; ++j)
                for (int i = 0; i < column.count; ++i) {
                    const double weight = rows.fractions[static_cast<std::size_t>(j)] *
                                          column.fractions[static_cast<std::size_t>(i)];
                    const float* texel =
                        &level.rgb[3 * (static_cast<std::size_t>(rows.first + j) *
                                            static_cast<std::size_t>(level.width) +
                                        static_cast<std::size_t>(column.first + i))];
                    for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * double{texel[c]};
                }
            for (const double value : sum) half.rgb.push_back(static_cast<float>(value));
        }
    }
    return half;
}

TextureGradient::TextureGradient(const Texture& texture) : texture_(&texture) {
    levels_.reserve(texture.levels_.size());
    for (const Texture::Level& level : texture.levels_) levels_.emplace_back(level.rgb.size());
}

void TextureGradient::add(double u, double v, const TextureLookup& lookup,
                          const TextureSpread& spread, const Rgb& weights) {
    texture_->visit(
        u, v, lookup, spread,
        [&](std::size_t level, double at_u, double at_v, const TextureLookup& how, double weight) {
            const Texture::Footprint around =
                Texture::footprint(texture_->levels_[level], at_u, at_v, how);
            for (std::size_t k = 0; k < around.count; ++k)
                for (std::size_t c = 0; c < 3; ++c)
                    levels_[level][3 * around.texels[k] + c] +=
                        weight * around.weights[k] * weights[c];
        });
}

std::vector<double> TextureGradient::by_texel() const {
    // From the coarsest level on, each texel passes its derivatives to those of which it is the
    // mean.
    std::vector<double> coarse = levels_.back();
    for (std::size_t i = levels_.size() - 1; i-- > 0;) {
        const Texture::Level& level = texture_->levels_[i];
        const Texture::Level& half = texture_->levels_[i + 1];
        std::vector<double> fine = levels_[i];
        for (int y = 0; y < half.height; ++y) {
            const HalvedTexel rows(y, level.height, half.height);
            for (int x = 0; x < half.width; ++x) {
                const HalvedTexel columns(x, level.width, half.width);
                const double* const from = &coarse[3 * (static_cast<std::size_t>(y) *
                                                            static_cast<std::size_t>(half.width) +
                                                        static_cast<std::size_t>(x))];
                for (int j = 0; j < rows.count; ++j)
                    for (int k = 0; k < columns.count; ++k) {
                        const double weight = rows.fractions[static_cast<std::size_t>(j)] *
                                              columns.fractions[static_cast<std::size_t>(k)];
                        double* const texel =
                            &fine[3 * (static_cast<std::size_t>(rows.first + j) *
                                           static_cast<std::size_t>(level.width) +
                                       static_cast<std::size_t>(columns.first + k))];
                        for (std::size_t c = 0; c < 3; ++c) texel[c] += weight * from[c];
                    }
            }
        }
        coarse = std::move(fine);
    }
    return coarse;
}

Texture::Footprint Texture::footprint(const Level& level, double u, double v,
                                      const TextureLookup& lookup) {
    const int width = level.width, height = level.height;
    const auto place = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    };
    const double x = u * level.columns, y = v * level.rows;
    if (lookup.filter == TextureFilter::nearest) {
        return {{place(wrapped(std::floor(x), width, lookup.wrap_u),
                       wrapped(std::floor(y), height, lookup.wrap_v))},
                {1.0},
                1};
    }
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
    const double fx = x - 0.5 - left, fy = y - 0.5 - top;
    const int x0 = wrapped(left, width, lookup.wrap_u);
    const int x1 = wrapped(left + 1, width, lookup.wrap_u);
    const int y0 = wrapped(top, height, lookup.wrap_v);
    const int y1 = wrapped(top + 1, height, lookup.wrap_v);
    return {{place(x0, y0), place(x1, y0), place(x0, y1), place(x1, y1)},
            {(1 - fy) * (1 - fx), (1 - fy) * fx, fy * (1 - fx), fy * fx},
            4};
}

Rgb Texture::sample(double u, double v, const TextureLookup& lookup) const {
    return sample(levels_.front(), u, v, lookup);
}

template <class LookUp>
void Texture::visit(double u, double v, const TextureLookup& lookup, const TextureSpread& spread,
                    const LookUp& look_up) const {
    std::array<double, 2> along = spread.across, beside = spread.down;
    const auto texels = [&](const std::array<double, 2>& side) {
        return std::hypot(side[0] * width(), side[1] * height());
    };
    if (texels(along) < texels(beside)) std::swap(along, beside);
    const double length = texels(along);
    if (!(length > 1)) {
        look_up(std::size_t{0}, u, v, lookup, 1.0);
        return;
    }
    // The height over the longer side, as wide as the parallelogram is beside it.
    const double area = std::abs(along[0] * beside[1] - along[1] * beside[0]) * width() * height();
    constexpr double k_max_lookups = 16;
    const double width_beside = std::max({area / length, length / k_max_lookups, 1.0});
    const int count = static_cast<int>(std::ceil(length / width_beside - 1e-9));
    const double last = static_cast<double>(levels_.size() - 1);
    const double level = std::min(std::log2(width_beside), last);
    const auto finer = static_cast<std::size_t>(level);
    const double coarser_weight = level - std::floor(level);
    const TextureLookup linear{TextureFilter::linear, lookup.wrap_u, lookup.wrap_v};
    for (int i = 0; i < count; ++i) {
        const double at = (i + 0.5) / count - 0.5;
        const double at_u = u + at * along[0], at_v = v + at * along[1];
        look_up(finer, at_u, at_v, linear, (1 - coarser_weight) / count);
        if (coarser_weight > 0) look_up(finer + 1, at_u, at_v, linear, coarser_weight / count);
    }
}

Rgb Texture::sample(double u, double v, const TextureLookup& lookup,
                    const TextureSpread& spread) const {
    Rgb sum{};
    visit(
        u, v, lookup, spread,
        [&](std::size_t level, double at_u, double at_v, const TextureLookup& how, double weight) {
            const Rgb texel = sample(levels_[level], at_u, at_v, how);
            for (std::size_t i = 0; i < 3; ++i) sum[i] += weight * texel[i];
        });
    return sum;
}

Rgb Texture::sample(const Level& level, double u, double v, const TextureLookup& lookup) const {
    const Footprint around = footprint(level, u, v, lookup);
    Rgb result{};
    if (level.rgb.empty()) {
        const auto width = static_cast<std::size_t>(level.width);
        const auto column = [&](std::size_t k) {
            return static_cast<int>(around.texels[k] % width);
        };
        const auto row = [&](std::size_t k) { return static_cast<int>(around.texels[k] / width); };
        std::array<Rgb, 4> texels;
        // Four that are neighbours, not at opposite ends of the texture, are read at once.
        if (around.count == 4 && column(3) == column(0) + 1 && row(3) == row(0) + 1)
            texels_of_file(level, column(0), row(0), 2, 2, texels);
        else
            for (std::size_t k = 0; k < around.count; ++k)
                texels_of_file(level, column(k), row(k), 1, 1, std::span(texels).subspan(k, 1));
        for (std::size_t k = 0; k < around.count; ++k)
            for (std::size_t i = 0; i < 3; ++i) result[i] += around.weights[k] * texels[k][i];
        return result;
    }
    for (std::size_t k = 0; k < around.count; ++k) {
        for (std::size_t i = 0; i < 3; ++i) {
            result[i] += around.weights[k] * level.rgb[3 * around.texels[k] + i];
        }
    }
    return result;
}

double Texture::sample_alpha(double u, double v, const TextureLookup& lookup) const {
    if (alpha_.empty() && !has_alpha_in_file_) return 1;
    const Footprint around = footprint(levels_.front(), u, v, lookup);
    double result = 0;
    if (has_alpha_in_file_) {
        for (std::size_t k = 0; k < around.count; ++k)
            result += around.weights[k] * alpha_of_file(around.texels[k]);
        return result;
    }
    for (std::size_t k = 0; k < around.count; ++k) {
        result += around.weights[k] * alpha_[around.texels[k]];
    }
    return result;
}

}  // namespace uw
