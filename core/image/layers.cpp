#include "core/image/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/cryptomatte.h"

namespace uw {
namespace {

/// Layers by how often light was scattered, and reflected.
constexpr std::array<std::string_view, 2> k_orders{"order", "reflections"};

/// What an image is unless more of it is requested: the total of all bands, and the depth.
constexpr std::array<Layer, 2> k_default_layers{Layer::total, Layer::depth};

constexpr std::string_view k_lamp_prefix = "lamp.";
/// EXR allows 255 bytes for "lamp.<name>.<band>nm".
constexpr std::size_t k_longest_lamp_name = 200;

/// One suffix per band: R, G, B or the wavelengths, with enough digits to distinguish them.
std::vector<std::string> band_suffixes(std::span<const double> bands_nm) {
    if (bands_nm.size() == 3) return {"R", "G", "B"};
    constexpr int k_digits_of_double = 17;
    for (int digits = 6; digits <= k_digits_of_double; ++digits) {
        std::vector<std::string> names;
        for (const double nm : bands_nm) {
            names.push_back(fmt::format("{:.{}g}nm", nm, digits));
            std::ranges::replace(names.back(), '.', '_');
        }
        if (std::set(names.begin(), names.end()).size() == names.size()) return names;
    }
    throw InputError("water.bands: a wavelength occurs twice; remove one");
}

std::optional<std::size_t> find_layer(std::string_view name) {
    const auto found = std::ranges::find(k_layers, name, &LayerKind::name);
    if (found == k_layers.end()) return std::nullopt;
    return static_cast<std::size_t>(found - k_layers.begin());
}

/// Every word that --layers accepts, for the message about an unknown one.
std::string hint_of(std::string_view item) {
    std::vector<std::string_view> words{"all", "default", "lamps", "lamp.<name>"};
    for (const LayerKind& layer : k_layers) words.push_back(layer.name);
    return suggestion(item, words);
}

bool is_possible(const LayerKind& kind, const LayerSupply& supply) {
    return kind.hint.empty() || supply.layers.has(kind.layer);
}

/// The endings of a layer's channels.
std::vector<std::string> suffixes_of(const LayerKind& kind, std::span<const std::string> bands,
                                     const LayerSupply& supply) {
    if (kind.suffixes.empty()) return {bands.begin(), bands.end()};
    if (kind.layer == Layer::sensor && supply.sensor_values == 1) return {"V"};
    std::vector<std::string> letters;
    for (const char letter : kind.suffixes) letters.emplace_back(1, letter);
    return letters;
}

/// A lamp's name becomes part of a channel name: readers end it at NUL, and control characters
/// corrupt terminals.
void check_lamp_name(const std::string& name) {
    const auto is_control = [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte < 0x20 || byte == 0x7f;
    };
    if (name.empty() || name.size() > k_longest_lamp_name ||
        std::ranges::any_of(name, is_control)) {
        throw InputError(fmt::format(
            "lamps: a name cannot serve as a layer name; use 1 to {} printable characters",
            k_longest_lamp_name));
    }
}

}  // namespace

bool is_image_channel(std::string_view channel_name) {
    return channel_name.find('.') == std::string_view::npos || channel_name.starts_with("total.");
}

bool is_light(std::string_view channel_name) {
    if (is_image_channel(channel_name) || channel_name.starts_with(k_lamp_prefix)) return true;
    const auto layer = find_layer(channel_name.substr(0, channel_name.rfind('.')));
    if (layer) return k_layers[*layer].is_light();
    const auto order = channel_name.substr(0, channel_name.find('.'));
    return std::ranges::find(k_orders, order) != k_orders.end();
}

/// The layers requested by --layers.
struct LayerPlan::Selection {
    LayerSupply supply;
    std::array<bool, k_layer_count> layers{};
    std::vector<bool> lamps{};

    bool has(Layer layer) const { return layers[static_cast<std::size_t>(layer)]; }
    void add(std::string_view item, std::span<const std::string> lamp_names);
    void add_all();
    void add_layer(std::size_t layer);
    void add_lamp(std::string_view name, std::span<const std::string> lamp_names);
};

void LayerPlan::Selection::add(std::string_view item, std::span<const std::string> lamp_names) {
    if (item == "all") add_all();
    if (item == "all" || item == "lamps") lamps.assign(lamps.size(), true);
    if (item == "default")
        for (const Layer layer : k_default_layers) layers[static_cast<std::size_t>(layer)] = true;
    if (item == "all" || item == "default" || item == "lamps") return;
    if (item.starts_with(k_lamp_prefix)) {
        add_lamp(item.substr(k_lamp_prefix.size()), lamp_names);
    } else if (const auto layer = find_layer(item)) {
        add_layer(*layer);
    } else if (std::ranges::find(k_orders, item.substr(0, item.find('.'))) != k_orders.end()) {
        throw UsageError(fmt::format(
            "--layers: {}: layers by order are written with --orders N; give that instead",
            printable(item)));
    } else {
        throw UsageError(
            fmt::format("--layers: '{}': unknown layer; {}", printable(item), hint_of(item)));
    }
}

void LayerPlan::Selection::add_all() {
    for (std::size_t i = 0; i < k_layer_count; ++i)
        if (k_layers[i].content != LayerContent::match &&
            k_layers[i].content != LayerContent::matte && is_possible(k_layers[i], supply))
            layers[i] = true;
}

void LayerPlan::Selection::add_layer(std::size_t layer) {
    const LayerKind& kind = k_layers[layer];
    if (!is_possible(kind, supply))
        throw UsageError(fmt::format("--layers: {}: {}", kind.name, kind.hint));
    layers[layer] = true;
}

void LayerPlan::Selection::add_lamp(std::string_view name,
                                    std::span<const std::string> lamp_names) {
    const auto found = std::ranges::find(lamp_names, name);
    if (found == lamp_names.end()) {
        const std::vector<std::string_view> names(lamp_names.begin(), lamp_names.end());
        throw UsageError(fmt::format("--layers: lamp.{}: the scene has no lamp of that name; {}",
                                     printable(name),
                                     names.empty() ? "it has no lamps" : suggestion(name, names)));
    }
    lamps[static_cast<std::size_t>(found - lamp_names.begin())] = true;
}

LayerPlan::LayerPlan(std::string_view request, std::span<const double> bands_nm,
                     std::span<const std::string> lamp_names, const LayerSupply& supply)
    : band_count_(bands_nm.size()),
      provided_(supply.layers),
      first_of_lamp_(lamp_names.size(), -1) {
    first_.fill(-1);
    Selection selection{.supply = supply};
    selection.lamps.resize(lamp_names.size());
    if (trimmed(request, " \t").empty()) request = "default";
    for (const std::string_view item : split(request, ','))
        selection.add(trimmed(item, " \t"), lamp_names);
    // Which it is made from.
    if (selection.has(Layer::sensor)) selection.add_layer(static_cast<std::size_t>(Layer::total));
    const std::vector<std::string> bands = band_suffixes(bands_nm);
    add_layers(selection, bands);
    add_lamps(selection, lamp_names, bands);
    if (supply.orders > 0) add_orders(supply.orders, bands);
}

void LayerPlan::add_layers(const Selection& selection, std::span<const std::string> bands) {
    for (std::size_t i = 0; i < k_layer_count; ++i) {
        const bool is_rgb = i == static_cast<std::size_t>(Layer::total) && band_count_ == 3;
        if (!selection.layers[i] || is_rgb) continue;
        const LayerKind& kind = k_layers[i];
        const std::size_t first = channel_names_.size();
        if (kind.content == LayerContent::matte)
            std::ranges::copy(
                matte_channels(kind.layer == Layer::crypto_object ? MatteOf::objects
                                                                  : MatteOf::materials),
                std::back_inserter(channel_names_));
        else
            add_channels(std::string(kind.name), suffixes_of(kind, bands, selection.supply));
        first_[i] = static_cast<int>(first);
        channel_counts_[i] = channel_names_.size() - first;
        groups_.push_back({kind.content, kind.layer, kind.is_by_band(), first, channel_counts_[i]});
    }
}

void LayerPlan::add_lamps(const Selection& selection, std::span<const std::string> lamp_names,
                          std::span<const std::string> bands) {
    std::set<std::string_view> named;
    for (std::size_t lamp = 0; lamp < lamp_names.size(); ++lamp) {
        if (!selection.lamps[lamp]) continue;
        check_lamp_name(lamp_names[lamp]);
        if (!named.insert(lamp_names[lamp]).second) {
            throw InputError(
                fmt::format("lamps: two are named '{}'; give each its own name to have its layer",
                            lamp_names[lamp]));
        }
        first_of_lamp_[lamp] = static_cast<int>(channel_names_.size());
        add_light(std::string(k_lamp_prefix) + lamp_names[lamp], bands);
    }
}

void LayerPlan::add_orders(int orders, std::span<const std::string> bands) {
    first_order_ = channel_names_.size();
    order_count_ = static_cast<std::size_t>(orders) + 2;
    for (const std::string_view what : k_orders) {
        for (int order = 0; order <= orders; ++order)
            add_light(fmt::format("{}.{}", what, order), bands);
        add_light(fmt::format("{}.more", what), bands);
    }
}

bool LayerPlan::has_lamps() const {
    return std::ranges::any_of(first_of_lamp_, [](int channel) { return channel >= 0; });
}

void LayerPlan::add_light(const std::string& name, std::span<const std::string> bands) {
    groups_.push_back(
        {LayerContent::light, Layer::count, true, channel_names_.size(), bands.size()});
    add_channels(name, bands);
}

void LayerPlan::add_channels(const std::string& layer, std::span<const std::string> suffixes) {
    for (const std::string& suffix : suffixes)
        channel_names_.push_back(fmt::format("{}.{}", layer, suffix));
}

}  // namespace uw
