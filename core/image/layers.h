#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace uw {

/// The layers of an image (docs: image layers) besides the colour R G B A, in the order in which
/// their channels are stored. Each has a line in k_layers, and one in k_pixel_layers
/// (core/passes/pixel_layers.h), which defines how it is filled from a pixel.
enum class Layer {
    total,
    direct,
    forward,
    backscatter,
    backscatter_first,
    multiple,
    multiple_volume,
    multiple_surface,
    snow,
    error,
    irradiance,
    exitance,
    lit,
    clean,
    transmittance,
    albedo,
    depth,
    range,
    path,
    normal,
    position,
    id,
    material,
    sensor,
    flow,
    flow_back,
    flow_occluded,
    disparity,
    disparity_occluded,
    count,  // not a layer: the number of layers
};
inline constexpr auto k_layer_count = static_cast<std::size_t>(Layer::count);

/// A layer's name in files and --layers.
struct LayerKind {
    Layer layer;
    std::string_view name;
    /// One channel per letter; one per band if empty. A sensor with one number per pixel has `V`.
    std::string_view suffixes;
    bool is_light = false;  // radiance, irradiance or exitance; else ground truth
};

/// Every layer, in the order of Layer.
inline constexpr std::array<LayerKind, k_layer_count> k_layers{{
    {Layer::total, "total", "", true},
    {Layer::direct, "direct", "", true},
    {Layer::forward, "forward", "", true},
    {Layer::backscatter, "backscatter", "", true},
    {Layer::backscatter_first, "backscatter_first", "", true},
    {Layer::multiple, "multiple", "", true},
    {Layer::multiple_volume, "multiple.volume", "", true},
    {Layer::multiple_surface, "multiple.surface", "", true},
    {Layer::snow, "snow", "", true},
    {Layer::error, "error", "", true},
    {Layer::irradiance, "irradiance", "", true},
    {Layer::exitance, "exitance", "", true},
    {Layer::lit, "lit", "V"},
    {Layer::clean, "clean", "", true},
    {Layer::transmittance, "transmittance", ""},
    {Layer::albedo, "albedo", ""},
    {Layer::depth, "depth", "Z"},
    {Layer::range, "range", "V"},
    {Layer::path, "path", "V"},
    {Layer::normal, "normal", "XYZ"},
    {Layer::position, "position", "XYZ"},
    {Layer::id, "id", "V"},
    {Layer::material, "material", "V"},
    {Layer::sensor, "sensor", "RGB"},
    {Layer::flow, "flow", "XY"},
    {Layer::flow_back, "flow_back", "XY"},
    {Layer::flow_occluded, "flow_occluded", "V"},
    {Layer::disparity, "disparity", "XY"},
    {Layer::disparity_occluded, "disparity_occluded", "V"},
}};

/// Whether a layer says where points are in another image: `all` leaves it out.
constexpr bool is_about_another_image(Layer layer) {
    return layer >= Layer::flow;
}

/// Whether a table holds one line for every layer, in order.
template <class Line>
constexpr bool has_every_layer(const std::array<Line, k_layer_count>& table) {
    for (std::size_t i = 0; i < table.size(); ++i)
        if (table[i].layer != static_cast<Layer>(i)) return false;
    return true;
}
static_assert(has_every_layer(k_layers));

/// Whether a channel, by its name, holds light or the image's coverage rather than ground truth.
bool is_light(std::string_view channel_name);
/// Whether it is of the image itself: R, G, B, A or the total of a band.
bool is_image_channel(std::string_view channel_name);

/// What an image can hold besides what every image can.
struct LayerSupply {
    bool multiple = false;   // light scattered or reflected more than once
    bool snow = false;       // marine snow
    bool error = false;      // the standard error
    bool flow = false;       // where points are in other frames
    bool disparity = false;  // where points are in another camera
    /// The light by how often it was scattered, and by how often it was reflected, each 0 to this;
    /// 0: not at all. These layers are in the plan without being requested.
    int orders = 0;
    std::size_t sensor_values = 0;  // numbers per pixel of the camera's sensor, 1 or 3; 0: none
};

/// Which channels an image has, what they are called, and where each layer begins.
///
/// The first four channels are always R, G, B, A. Layers of one value per band are named
/// `direct.R`, `direct.G`, `direct.B` with three bands and `direct.540nm` with any other number; a
/// decimal point is written as an underscore (`direct.540_5nm`), since readers take everything
/// before the last point as the layer. Then the total per band is a layer of its own, `total`; with
/// three bands it is R G B. The others: `lit.V`, `depth.Z`, `range.V`, `path.V`, `normal.X .Y .Z`,
/// `position.X .Y .Z`, `id.V`, `material.V`, `sensor.V` or `sensor.R .G .B`, `flow.X .Y`,
/// `flow_back.X .Y`, `flow_occluded.V`, `disparity.X .Y`, `disparity_occluded.V`. A lamp's own
/// light is `lamp.<name>.R` and so on; light scattered n times is `order.<n>.R`, what is scattered
/// more often than LayerSupply::orders `order.more.R`, and by reflections likewise
/// `reflections.<n>.R`.
class LayerPlan {
  public:
    /// `request` is the argument of --layers: comma-separated layers, including `lamps` for every
    /// lamp, `lamp.<name>` for one, `all`, and `default` for the image with its depth. Empty means
    /// `default`. Order and repetition do not matter. `sensor` brings `total` with it. `all` leaves
    /// out what is not in `supply` and what is about another image. Throws UsageError for an
    /// unknown layer or lamp, and for one that is not in `supply`; InputError if bands or lamps
    /// cannot be distinguished by name or a lamp's name is not valid in a channel name.
    LayerPlan(std::string_view request, std::span<const double> bands_nm,
              std::span<const std::string> lamp_names, const LayerSupply& supply = {});

    /// The names of all channels in the file, in order.
    const std::vector<std::string>& channel_names() const { return channel_names_; }

    /// Index of the layer's first channel; its others follow. -1 if it was not requested.
    int first_channel(Layer layer) const { return first_[static_cast<std::size_t>(layer)]; }
    bool has(Layer layer) const { return first_channel(layer) >= 0; }
    /// The same for the light of one lamp, by its index in the scene.
    int first_channel_of_lamp(std::size_t lamp) const { return first_of_lamp_[lamp]; }
    /// Whether the light of any single lamp was requested.
    bool has_lamps() const;

    /// The layer's channels among all those of a pixel. Precondition: has(layer).
    std::span<float> channels(Layer layer, std::span<float> pixel) const {
        return pixel.subspan(static_cast<std::size_t>(first_channel(layer)),
                             channel_counts_[static_cast<std::size_t>(layer)]);
    }
    /// The same for one lamp's light; empty if it was not requested.
    std::span<float> lamp_channels(std::size_t lamp, std::span<float> pixel) const {
        const int begin = first_channel_of_lamp(lamp);
        if (begin < 0) return {};
        return pixel.subspan(static_cast<std::size_t>(begin), band_count_);
    }
    std::size_t band_count() const { return band_count_; }

    /// Number of layers of light by how often it was scattered, and of layers by how often it was
    /// reflected; the last is that of all more often. 0 if they were not requested.
    std::size_t order_count() const { return order_count_; }
    /// Their channels among all those of a pixel.
    std::span<float> order_channels(std::size_t order, std::span<float> pixel) const {
        return pixel.subspan(first_order_ + order * band_count_, band_count_);
    }
    std::span<float> reflection_channels(std::size_t order, std::span<float> pixel) const {
        return order_channels(order_count_ + order, pixel);
    }

  private:
    struct Selection;
    void add_layers(const Selection& selection, std::span<const std::string> bands);
    void add_lamps(const Selection& selection, std::span<const std::string> lamp_names,
                   std::span<const std::string> bands);
    void add_orders(int orders, std::span<const std::string> bands);
    void add_channels(const std::string& layer, std::span<const std::string> suffixes);

    std::vector<std::string> channel_names_{"R", "G", "B", "A"};
    std::size_t band_count_;
    std::array<int, k_layer_count> first_{};
    std::array<std::size_t, k_layer_count> channel_counts_{};
    std::vector<int> first_of_lamp_;
    std::size_t first_order_ = 0, order_count_ = 0;
};

}  // namespace uw
