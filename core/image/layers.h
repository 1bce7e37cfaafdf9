#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace uw {

/// The layers of an image (docs: image layers) besides the colour R G B A, in the order in which
/// their channels are stored. Each is described in k_layers; how it is filled from a pixel is a
/// line in core/passes/pixel_layers.cpp.
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
    plume_optical_depth,
    plume_opacity,
    plume_range_50,
    plume_range_10,
    crypto_object,
    crypto_material,
    sensor,
    flow,
    flow_back,
    flow_occluded,
    plume_flow,
    disparity,
    disparity_occluded,
    count,  // not a layer: the number of layers
};
inline constexpr auto k_layer_count = static_cast<std::size_t>(Layer::count);

/// What a layer holds, which decides how it is stored, and what becomes of it where an image is a
/// mean over light paths or over the time of an exposure.
enum class LayerContent {
    light,     ///< radiance: a mean over paths and over an exposure
    exact,     ///< light that no path estimates, or its error: of an exposure, not of paths
    fraction,  ///< from 0 to 1, not light: a mean over an exposure
    point,     ///< ground truth of the point that a pixel's centre sees; 0 where it sees none
    ray,       ///< ground truth of the water along the ray of a pixel's centre; 0 without a ray
    matte,     ///< what the pixel shows and how much of each: `all` leaves it out
    match,     ///< where that point is in another image: `all` leaves it out
    number,    ///< the sensor's
};

/// Whether it is of all of an exposure, not of its middle.
constexpr bool is_of_exposure(LayerContent content) {
    return content == LayerContent::light || content == LayerContent::exact ||
           content == LayerContent::fraction || content == LayerContent::matte;
}

/// All that is said of a layer besides how it is filled.
struct LayerKind {
    /// The effect of forward scatter, a second pass over the image, on a layer.
    enum class ForwardScatter { leaves, replaces, adds };

    Layer layer;
    LayerContent content;
    std::string_view name;  ///< in files and --layers
    /// One channel per letter; one per band if empty. A sensor with one number per pixel has `V`.
    /// A matte has layers of four, which compositors look for by their names (cryptomatte.h).
    std::string_view suffixes{};
    /// Why an image lacks the layer, and what to write to have it; empty if every image has it,
    /// else a pass has to provide it (LayerSupply).
    std::string_view hint{};
    ForwardScatter forward_scatter = ForwardScatter::leaves;

    constexpr bool is_light() const {
        return content == LayerContent::light || content == LayerContent::exact;
    }
    constexpr bool is_by_band() const { return suffixes.empty() && content != LayerContent::matte; }
};

namespace layer_hints {
inline constexpr std::string_view
    k_plume = "there is no plume in the scene; add volumes with grids",
    k_plume_flow =
        "no volume says how it moves; give one its velocity, and the sequence's --frames",
    k_multiple =
        "the scene is rendered with single scattering; write --set render.scattering=multiple, or "
        "--integrator path",
    k_snow = "there is no snow in the scene; add water.snow",
    k_error =
        "only all light has a standard error; write --set render.scattering=multiple, or "
        "--integrator path with at least two samples",
    k_sensor = "the camera has no sensor; add camera.sensor to the scene",
    k_flow = "other frames are those of a sequence; give its --frames",
    k_disparity = "needs a rig of at least two cameras; give cameras: a list of them";
}  // namespace layer_hints

/// Every layer, in the order of Layer.
inline constexpr std::array<LayerKind, k_layer_count> k_layers{{
    {Layer::total, LayerContent::light, "total", "", "", LayerKind::ForwardScatter::replaces},
    {Layer::direct, LayerContent::light, "direct", "", "", LayerKind::ForwardScatter::replaces},
    {Layer::forward, LayerContent::light, "forward", "", "", LayerKind::ForwardScatter::replaces},
    {Layer::backscatter, LayerContent::light, "backscatter", "", "",
     LayerKind::ForwardScatter::replaces},
    {Layer::backscatter_first, LayerContent::light, "backscatter_first", "", "",
     LayerKind::ForwardScatter::adds},
    {Layer::multiple, LayerContent::light, "multiple", "", layer_hints::k_multiple},
    {Layer::multiple_volume, LayerContent::light, "multiple.volume", "", layer_hints::k_multiple},
    {Layer::multiple_surface, LayerContent::light, "multiple.surface", "", layer_hints::k_multiple},
    {Layer::snow, LayerContent::light, "snow", "", layer_hints::k_snow},
    {Layer::error, LayerContent::exact, "error", "", layer_hints::k_error},
    {Layer::irradiance, LayerContent::exact, "irradiance"},
    {Layer::exitance, LayerContent::exact, "exitance"},
    {Layer::lit, LayerContent::fraction, "lit", "V"},
    {Layer::clean, LayerContent::exact, "clean"},
    {Layer::transmittance, LayerContent::fraction, "transmittance"},
    {Layer::albedo, LayerContent::point, "albedo"},
    {Layer::depth, LayerContent::point, "depth", "Z"},
    {Layer::range, LayerContent::point, "range", "V"},
    {Layer::path, LayerContent::point, "path", "V"},
    {Layer::normal, LayerContent::point, "normal", "XYZ"},
    {Layer::position, LayerContent::point, "position", "XYZ"},
    {Layer::id, LayerContent::point, "id", "V"},
    {Layer::material, LayerContent::point, "material", "V"},
    {Layer::plume_optical_depth, LayerContent::ray, "plume.optical_depth", "",
     layer_hints::k_plume},
    {Layer::plume_opacity, LayerContent::ray, "plume.opacity", "V", layer_hints::k_plume},
    {Layer::plume_range_50, LayerContent::ray, "plume.range_50", "V", layer_hints::k_plume},
    {Layer::plume_range_10, LayerContent::ray, "plume.range_10", "V", layer_hints::k_plume},
    {Layer::crypto_object, LayerContent::matte, "crypto_object"},
    {Layer::crypto_material, LayerContent::matte, "crypto_material"},
    {Layer::sensor, LayerContent::number, "sensor", "RGB", layer_hints::k_sensor},
    {Layer::flow, LayerContent::match, "flow", "XY", layer_hints::k_flow},
    {Layer::flow_back, LayerContent::match, "flow_back", "XY", layer_hints::k_flow},
    {Layer::flow_occluded, LayerContent::match, "flow_occluded", "V", layer_hints::k_flow},
    {Layer::plume_flow, LayerContent::match, "plume.flow", "XY", layer_hints::k_plume_flow},
    {Layer::disparity, LayerContent::match, "disparity", "XY", layer_hints::k_disparity},
    {Layer::disparity_occluded, LayerContent::match, "disparity_occluded", "V",
     layer_hints::k_disparity},
}};

constexpr const LayerKind& kind_of(Layer layer) {
    return k_layers[static_cast<std::size_t>(layer)];
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

/// Some of the layers.
class LayerSet {
  public:
    constexpr LayerSet() = default;
    constexpr LayerSet(std::initializer_list<Layer> layers) {
        for (const Layer layer : layers) bits_ |= bit(layer);
    }
    constexpr bool has(Layer layer) const { return (bits_ & bit(layer)) != 0; }
    constexpr LayerSet& operator|=(LayerSet more) {
        bits_ |= more.bits_;
        return *this;
    }

  private:
    static_assert(k_layer_count <= 64);
    static constexpr std::uint64_t bit(Layer layer) {
        return std::uint64_t{1} << static_cast<unsigned>(layer);
    }

    std::uint64_t bits_ = 0;
};

/// What the passes of an image provide besides what every image has.
struct LayerSupply {
    LayerSet layers{};
    /// The light by how often it was scattered, and by how often it was reflected, each 0 to this;
    /// 0: not at all. These layers are in the plan without being requested.
    int orders = 0;
    std::size_t sensor_values = 0;  // numbers per pixel of the camera's sensor, 1 or 3
};

/// Adjacent channels of an image: the colour R G B, the coverage A, a layer, or the light of one
/// lamp or order.
struct ChannelGroup {
    LayerContent content;
    Layer layer;              ///< Layer::count if it is not a layer of k_layers
    bool is_by_band;          ///< whether there is one channel per band
    std::size_t first, size;  ///< of its channels

    std::span<float> of(std::span<float> pixel) const { return pixel.subspan(first, size); }
};

/// Which channels an image has, what they are called, and where each layer begins.
///
/// The first four channels are always R, G, B, A. Layers of one value per band are named
/// `direct.R`, `direct.G`, `direct.B` with three bands and `direct.540nm` with any other number; a
/// decimal point is written as an underscore (`direct.540_5nm`), since readers take everything
/// before the last point as the layer. Then the total per band is a layer of its own, `total`; with
/// three bands it is R G B. The others: `lit.V`, `depth.Z`, `range.V`, `path.V`, `normal.X .Y .Z`,
/// `position.X .Y .Z`, `id.V`, `material.V`, `plume.optical_depth.R` and so
/// on, `plume.opacity.V`, `plume.range_50.V`, `plume.range_10.V`, `CryptoObject00.R` and so on
/// (cryptomatte.h), `sensor.V` or `sensor.R .G .B`, `flow.X .Y`, `flow_back.X .Y`,
/// `flow_occluded.V`, `plume.flow.X .Y`, `disparity.X .Y`, `disparity_occluded.V`. A lamp's own
/// light is `lamp.<name>.R` and so on; light scattered n times is `order.<n>.R`, what is scattered
/// more often than LayerSupply::orders `order.more.R`, and by reflections likewise
/// `reflections.<n>.R`.
class LayerPlan {
  public:
    /// `request` is the argument of --layers: comma-separated layers, including `lamps` for every
    /// lamp, `lamp.<name>` for one, `all`, and `default` for the image with its depth. Empty means
    /// `default`. Order and repetition do not matter. `sensor` brings `total` with it. `all` leaves
    /// out mattes, what is not in `supply` and what is about another image. Throws UsageError for
    /// an unknown layer or lamp, and for one that is not in `supply`; InputError if bands or lamps
    /// cannot be distinguished by name or a lamp's name is not valid in a channel name.
    LayerPlan(std::string_view request, std::span<const double> bands_nm,
              std::span<const std::string> lamp_names, const LayerSupply& supply = {});

    /// The names of all channels in the file, in order.
    const std::vector<std::string>& channel_names() const { return channel_names_; }

    /// The same channels in groups. What is done to all light of an image goes through these, so
    /// that a new layer has no line of its own there.
    std::span<const ChannelGroup> groups() const { return groups_; }

    /// Index of the layer's first channel; its others follow. -1 if it was not requested.
    int first_channel(Layer layer) const { return first_[static_cast<std::size_t>(layer)]; }
    bool has(Layer layer) const { return first_channel(layer) >= 0; }
    /// Whether a pass provides the layer, requested or not: light that none does is 0.
    bool is_provided(Layer layer) const { return provided_.has(layer); }
    /// The same for the light of one lamp, by its index in the scene.
    int first_channel_of_lamp(std::size_t lamp) const { return first_of_lamp_[lamp]; }
    /// The scene's lamps, requested or not.
    std::size_t lamp_count() const { return first_of_lamp_.size(); }
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
    void add_light(const std::string& name, std::span<const std::string> bands);
    void add_channels(const std::string& layer, std::span<const std::string> suffixes);

    std::vector<std::string> channel_names_{"R", "G", "B", "A"};
    std::vector<ChannelGroup> groups_{{LayerContent::light, Layer::count, false, 0, 3},
                                      {LayerContent::fraction, Layer::count, false, 3, 1}};
    std::size_t band_count_;
    LayerSet provided_;
    std::array<int, k_layer_count> first_{};
    std::array<std::size_t, k_layer_count> channel_counts_{};
    std::vector<int> first_of_lamp_;
    std::size_t first_order_ = 0, order_count_ = 0;
};

}  // namespace uw
