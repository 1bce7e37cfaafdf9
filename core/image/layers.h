#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace uw {

/// The layers of an image (docs: image layers) besides the colour R G B A, in the order in which
/// their channels are stored.
enum class Layer {
    total,
    direct,
    forward,
    backscatter,
    backscatter_first,
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
};
inline constexpr std::size_t k_layer_count = 17;

/// Which channels an image has, what they are called, and where each layer begins.
///
/// The first four channels are always R, G, B, A. Layers of one value per band are named
/// `direct.R`, `direct.G`, `direct.B` with three bands and `direct.540nm` with any other number;
/// a fraction's point is written as an underscore (`direct.540_5nm`), for readers take what stands
/// before the last point as the layer. Then the total per band is a layer of its own, `total`;
/// with three bands it is R G B. The others: `lit.V`, `depth.Z`, `range.V`, `path.V`,
/// `normal.X .Y .Z`, `position.X .Y .Z`, `id.V`. A lamp's own light is `lamp.<name>.R` and so on.
class LayerPlan {
  public:
    /// `request` is what --layers was given: layers separated by commas, among them `lamps` for
    /// every lamp, `lamp.<name>` for one, `all`, and `default` for everything but the lamps. Empty
    /// is `default`. Order and repetition do not matter.
    /// Throws UsageError for an unknown layer or lamp, or one that is not supported yet;
    /// InputError if bands or lamps cannot be told apart by name or a lamp's name is no channel's.
    LayerPlan(std::string_view request, std::span<const double> bands_nm,
              std::span<const std::string> lamp_names);

    /// Every channel by its name in the file, in order.
    const std::vector<std::string>& channel_names() const { return channel_names_; }

    /// Index of the layer's first channel; its others follow. -1 if it was not asked for.
    int first_channel(Layer layer) const { return first_[static_cast<std::size_t>(layer)]; }
    bool has(Layer layer) const { return first_channel(layer) >= 0; }
    /// Likewise for the light of one lamp, by its index in the scene.
    int first_channel_of_lamp(std::size_t lamp) const { return first_of_lamp_[lamp]; }

  private:
    struct Selection;
    void add_channels(const std::string& layer, std::span<const std::string> suffixes);

    std::vector<std::string> channel_names_{"R", "G", "B", "A"};
    std::array<int, k_layer_count> first_{};
    std::vector<int> first_of_lamp_;
};

}  // namespace uw
