#include "edit/session/picture_mix.h"

#include <algorithm>
#include <array>
#include <utility>

namespace uw {

namespace {

// By which the light of a lamp, rendered with `rendered`, is multiplied.
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
        constexpr std::array<std::pair<Layer, Planes>, 8> k_meanings{
            {{Layer::direct, &PictureLayers::signal},
             {Layer::forward, &PictureLayers::signal},
             {Layer::multiple_surface, &PictureLayers::signal},
             {Layer::backscatter, &PictureLayers::backscatter},
             {Layer::multiple_volume, &PictureLayers::backscatter},
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

Json numbers_json(const PictureNumbers& numbers) {
    const auto optional = [](const std::optional<double>& value) {
        return value ? number_json(*value) : Json(nullptr);
    };
    Json evenness;
    if (const auto& e = numbers.evenness)
        evenness = {{"mean", number_json(e->mean)},
                    {"least", number_json(e->least)},
                    {"greatest", number_json(e->greatest)},
                    {"percentile5", number_json(e->percentile5)},
                    {"median", number_json(e->median)},
                    {"percentile95", number_json(e->percentile95)},
                    {"least_to_mean", number_json(e->least_to_mean)},
                    {"percentile5_to_mean", number_json(e->percentile5_to_mean)},
                    {"pixels", e->pixels}};
    return {{"signal", number_json(numbers.signal)},
            {"backscatter", number_json(numbers.backscatter)},
            {"signal_to_backscatter", number_json(numbers.signal_to_backscatter)},
            {"contrast", number_json(numbers.contrast)},
            {"clean_contrast", optional(numbers.clean_contrast)},
            {"share_above", number_json(numbers.share_above)},
            {"lost_to_water", optional(numbers.lost_to_water)},
            {"evenness", std::move(evenness)}};
}

Json target_numbers_json(const TargetNumbers& numbers) {
    return {{"distance", number_json(numbers.distance)},
            {"contrast", number_json(numbers.contrast)},
            {"signal", number_json(numbers.signal)},
            {"backscatter", number_json(numbers.backscatter)},
            {"signal_to_backscatter", number_json(numbers.signal_to_backscatter)},
            {"irradiance", number_json(numbers.irradiance)}};
}

}  // namespace uw
