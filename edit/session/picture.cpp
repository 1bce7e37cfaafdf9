#include "edit/session/picture.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <utility>

#include "core/base/json.h"
#include "core/image/colour.h"

namespace uw {

namespace {

// The first picture while a lamp is dragged, and the last, have so many pixels: the latter is more
// than a page shows.
constexpr double k_small_pixels = 160 * 90, k_max_pixels = 1920 * 1200;
constexpr double k_draft_width = 480, k_draft_height = 270;

/// Layers that are sent if the picture has them.
constexpr std::array k_lamp_layers{Layer::direct,    Layer::forward, Layer::backscatter,
                                   Layer::multiple,  Layer::snow,    Layer::clean,
                                   Layer::irradiance};
constexpr std::array k_unlit_layers{Layer::direct, Layer::forward, Layer::multiple, Layer::snow,
                                    Layer::clean};

std::string_view layer_name(Layer layer) {
    return k_layers[static_cast<std::size_t>(layer)].name;
}

// The IEEE 754 half that is nearest (ties to even) to a value of magnitude up to 1. Rounding is
// left to the addition of floats where halves are subnormal, and to that of integers elsewhere.
std::uint16_t half_bits(float value) {
    constexpr std::uint32_t k_normal = 0x38800000U;  // 2^-14, the least normal half
    constexpr float k_subnormal = 0.5F;              // whose last bit is 2^-24
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t magnitude = bits & 0x7fffffffU;
    const std::uint32_t subnormal =
        std::bit_cast<std::uint32_t>(std::bit_cast<float>(magnitude) + k_subnormal) -
        std::bit_cast<std::uint32_t>(k_subnormal);
    const std::uint32_t odd = (magnitude >> 13) & 1U;
    const std::uint32_t normal = (magnitude - (112U << 23) + 0xfffU + odd) >> 13;
    return static_cast<std::uint16_t>(((bits >> 16) & 0x8000U) |
                                      (magnitude < k_normal ? subnormal : normal));
}

// The least power of two that is not below any of the values, whatever their sign.
float power_above(std::span<const float> values) {
    float most = 0;
    for (const float value : values) {
        const float magnitude = std::abs(value);
        if (magnitude > most && magnitude <= std::numeric_limits<float>::max()) most = magnitude;
    }
    return most > 0 ? std::ldexp(1.0F, std::ilogb(most) + 1) : 1.0F;
}

/// Collects planes, and what they are.
class PlaneWriter {
  public:
    PlaneWriter(const Picture& picture, SampleType type)
        : colour_(make_band_colour(picture.scene->scene.desc().render.colour,
                                   picture.scene->scene.desc().water.bands_nm)),
          bands_(picture.scene->bands()),
          is_plain_(picture.scene->has_plain_colour),
          type_(type) {}

    /// A layer of one value per band, as colours.
    void add_light(const LightLayers& layers, Layer layer, const std::string& lamp) {
        if (!layers.plan.has(layer)) return;
        collect(layers, layer, 3, [&](const float* pixel, float* to) {
            if (is_plain_) {
                std::copy_n(pixel, 3, to);
                return;
            }
            Spectrum radiance{};
            for (std::size_t b = 0; b < bands_; ++b) radiance[b] = static_cast<double>(pixel[b]);
            std::ranges::transform(colour_(radiance), to,
                                   [](double c) { return static_cast<float>(c); });
        });
        finish(layer, lamp.empty() ? Json(nullptr) : Json(lamp), 3);
    }
    /// A layer of a single value.
    void add_value(const LightLayers& layers, Layer layer) {
        collect(layers, layer, 1, [](const float* pixel, float* to) { *to = *pixel; });
        finish(layer, nullptr, 1);
    }

    const Json& planes() const { return planes_; }
    const std::string& bytes() const { return bytes_; }

  private:
    template <class Take>
    void collect(const LightLayers& layers, Layer layer, std::size_t count, const Take& take) {
        const std::size_t channels = layers.film.channel_names().size();
        const auto first = static_cast<std::size_t>(layers.plan.first_channel(layer));
        const std::span<const float> all = layers.film.values();
        values_.resize(all.size() / channels * count);
        float* to = values_.data();
        for (std::size_t at = first; at < all.size(); at += channels, to += count)
            take(&all[at], to);
    }

    void finish(Layer layer, Json lamp, int channels) {
        const float factor = type_ == SampleType::f16 ? power_above(values_) : 1;
        planes_.push_back({{"lamp", std::move(lamp)},
                           {"layer", layer_name(layer)},
                           {"channels", channels},
                           {"factor", factor}});
        if (type_ == SampleType::f32) {
            append(values_.data(), sizeof(float) * values_.size());
            return;
        }
        // Values that are not finite cannot be scaled, and are shown as 0.
        halves_.resize(values_.size());
        const float scale = 1 / factor;
        std::ranges::transform(values_, halves_.begin(), [scale](float value) {
            const float scaled = value * scale;
            return half_bits(std::abs(scaled) <= 1 ? scaled : 0);
        });
        append(halves_.data(), sizeof(std::uint16_t) * halves_.size());
    }

    void append(const void* from, std::size_t size) {
        const std::size_t at = bytes_.size();
        bytes_.resize(at + size);
        std::memcpy(bytes_.data() + at, from, size);
    }

    BandColour colour_;
    std::size_t bands_;
    bool is_plain_;
    SampleType type_;
    Json planes_ = Json::array();
    std::vector<float> values_;          // of one plane
    std::vector<std::uint16_t> halves_;  // likewise
    std::string bytes_;
};

}  // namespace

std::string_view name_of(PictureQuality quality) {
    constexpr std::array<std::string_view, k_picture_qualities> k_names{"first", "small", "draft",
                                                                        "full-draft", "final"};
    return k_names[static_cast<std::size_t>(quality)];
}

std::pair<int, int> picture_size(PictureQuality quality, int width, int height) {
    const double pixels = static_cast<double>(width) * height;
    double scale = std::min(1.0, std::sqrt(k_max_pixels / pixels));
    if (quality <= PictureQuality::small)
        scale = std::min(scale, std::sqrt(k_small_pixels / pixels));
    if (quality == PictureQuality::draft)
        scale = std::min({scale, k_draft_width / width, k_draft_height / height});
    const auto scaled = [&](int side) {
        return std::max(1, static_cast<int>(std::lround(side * scale)));
    };
    return {scaled(width), scaled(height)};
}

std::string picture_bytes(const Picture& picture, SampleType type) {
    const EditedScene& scene = *picture.scene;
    const SceneDesc& desc = scene.scene.desc();
    PlaneWriter writer(picture, type);
    Json names = Json::array(), brightness = Json::array();
    for (std::size_t i = 0; i < picture.lamps.size(); ++i) {
        const std::string& name = desc.lamps[i].name;
        names.push_back(name);
        brightness.push_back(list_json(scene.colour_scale(picture.lamps[i]->brightness)));
        for (const Layer layer : k_lamp_layers) writer.add_light(*picture.lamps[i], layer, name);
    }
    for (const Layer layer : k_unlit_layers) writer.add_light(*picture.unlit, layer, "");
    writer.add_value(*picture.unlit, Layer::depth);

    const Json header = {
        {"key", picture.number},
        {"revision", scene.revision},
        {"width", picture.width},
        {"height", picture.height},
        {"scale", static_cast<double>(desc.camera.width) / picture.width},
        {"quality", name_of(picture.quality)},
        {"bands", 3},
        {"lamps", std::move(names)},
        {"lamp_brightness", std::move(brightness)},
        {"planes", writer.planes()},
        {"type", type == SampleType::f16 ? "f16" : "f32"},
    };
    std::string text = header.dump(-1, ' ', false, Json::error_handler_t::replace);
    // The planes begin at a multiple of 16 bytes.
    text.resize((text.size() + 4 + 15) / 16 * 16 - 4, ' ');
    std::string bytes(4, '\0');
    for (std::size_t i = 0; i < 4; ++i)
        bytes[i] = static_cast<char>((text.size() >> (8 * i)) & 0xff);
    return bytes + text + writer.bytes();
}

namespace {

// The factor on the light of a lamp that was rendered with the brightness `rendered`.
Spectrum gain_of(const EditedLamp& lamp, const Spectrum& rendered, std::size_t bands) {
    if (!lamp.on) return {};
    return per_band(bands, [&](std::size_t b) {
        return rendered[b] > 0 ? lamp.brightness[b] / rendered[b] : 0;
    });
}

class Mix {
  public:
    explicit Mix(PictureLayers& layers) : layers_(layers) {}

    void add(const LightLayers& light, const Spectrum& gain) {
        using Planes = std::vector<PicturePlane> PictureLayers::*;
        constexpr std::array<std::pair<Layer, Planes>, 9> k_meanings{
            {{Layer::direct, &PictureLayers::signal},
             {Layer::forward, &PictureLayers::signal},
             {Layer::multiple_surface, &PictureLayers::signal},
             {Layer::backscatter, &PictureLayers::backscatter},
             {Layer::multiple_volume, &PictureLayers::backscatter},
             {Layer::snow, &PictureLayers::backscatter},
             {Layer::clean, &PictureLayers::clean},
             {Layer::irradiance, &PictureLayers::irradiance},
             {Layer::albedo, &PictureLayers::albedo}}};
        for (const auto& [layer, planes] : k_meanings) {
            if (!light.plan.has(layer)) continue;
            const auto first = static_cast<std::size_t>(light.plan.first_channel(layer));
            (layers_.*planes)
                .push_back(
                    {light.film.values().subspan(first), light.film.channel_names().size(), gain});
        }
    }

  private:
    PictureLayers& layers_;
};

}  // namespace

bool is_same_picture(const EditedScene& a, const EditedScene& b) {
    return a.surrounding == b.surrounding &&
           std::ranges::equal(a.lamps, b.lamps, {}, &EditedLamp::key, &EditedLamp::key);
}

PictureLayers mixed_layers(const Picture& picture, const EditedScene& now) {
    PictureLayers layers;
    layers.width = picture.width;
    layers.height = picture.height;
    layers.bands = now.bands();
    Mix mix(layers);
    for (std::size_t i = 0; i < picture.lamps.size(); ++i)
        mix.add(*picture.lamps[i],
                gain_of(now.lamps[i], picture.lamps[i]->brightness, layers.bands));
    mix.add(*picture.unlit, per_band(layers.bands, [](std::size_t) { return 1.0; }));
    return layers;
}

}  // namespace uw
