#include "edit/session/edited_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "core/colour/colour_response.h"
#include "core/lamps/lamp_factory.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

constexpr std::array<std::string_view, 7> k_brightness_keys{
    "name", "spectrum", "intensity", "power", "lumens", "irradiance", "lux"};

void remove_keys(ConfigNode& map, std::span<const std::string_view> keys) {
    std::erase_if(map.entries, [&](const ConfigNode::Entry& entry) {
        return std::ranges::find(keys, entry.key) != keys.end();
    });
}

std::string hash_without(ConfigNode map, std::span<const std::string_view> keys) {
    remove_keys(map, keys);
    return config_hash(map);
}

// The bands' proportions, which an image in colours that are not the bands cannot be freed of.
std::string proportions(const Spectrum& brightness, std::size_t bands) {
    double most = 0;
    for (std::size_t b = 0; b < bands; ++b) most = std::max(most, brightness[b]);
    std::string text;
    for (std::size_t b = 0; b < bands; ++b)
        text += fmt::format(" {:.9g}", most > 0 ? brightness[b] / most : 1);
    return text;
}

bool is_plain(const BandColour& colour, std::size_t bands) {
    if (bands != 3) return false;
    for (std::size_t b = 0; b < bands; ++b) {
        Spectrum one{};
        one[b] = 1;
        const LinearRgb rgb = colour(one);
        for (std::size_t c = 0; c < 3; ++c)
            if (rgb[c] != (b == c ? 1 : 0)) return false;
    }
    return true;
}

EditedLamp make_edited_lamp(EditedScene& edited, const ConfigNode* entries, std::size_t index) {
    const SceneDesc& desc = edited.scene.desc();
    const LampDesc& lamp = desc.lamps[index];
    EditedLamp made;
    made.brightness =
        make_lamp(lamp, desc.camera.world_from_camera, desc.water.bands_nm, edited.warnings)
            .axis_intensity();
    // The lamps of glTF files follow those of the scene file.
    if (entries && index < entries->items.size()) {
        made.entry = index;
        made.key = hash_without(entries->items[index], k_brightness_keys);
    } else {
        made.key = "gltf " + lamp.name;
    }
    if (!edited.has_plain_colour) made.key += proportions(made.brightness, edited.bands());
    return made;
}

}  // namespace

std::optional<std::size_t> EditedScene::find_lamp(std::string_view name) const {
    const auto& all = scene.desc().lamps;
    const auto found = std::ranges::find(all, name, &LampDesc::name);
    if (found == all.end()) return std::nullopt;
    return static_cast<std::size_t>(found - all.begin());
}

std::array<double, 3> EditedScene::colour_scale(const Spectrum& brightness) const {
    if (has_plain_colour) return {brightness[0], brightness[1], brightness[2]};
    double most = 0;
    for (std::size_t b = 0; b < bands(); ++b) most = std::max(most, brightness[b]);
    return {most, most, most};
}

std::shared_ptr<const EditedScene> make_edited_scene(std::string_view text, const ConfigNode& tree,
                                                     const std::filesystem::path& file,
                                                     const std::vector<std::string>& off,
                                                     std::int64_t revision) {
    auto edited = std::make_shared<EditedScene>(load_scene_text(text, file));
    edited->revision = revision;
    const SceneDesc& desc = edited->scene.desc();
    edited->warnings = desc.warnings;
    edited->camera = std::make_shared<Camera>(desc.camera);
    edited->has_plain_colour =
        is_plain(make_band_colour(desc.render.colour, desc.water.bands_nm), edited->bands());
    edited->surrounding = hash_without(tree, std::array<std::string_view, 1>{"lamps"});
    const ConfigNode* entries = tree.find("lamps");
    for (std::size_t i = 0; i < desc.lamps.size(); ++i) {
        edited->lamps.push_back(make_edited_lamp(*edited, entries, i));
        edited->lamps.back().on = std::ranges::find(off, desc.lamps[i].name) == off.end();
    }
    return edited;
}

}  // namespace uw
