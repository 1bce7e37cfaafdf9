#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "camera/camera.h"
#include "core/base/spectrum.h"
#include "core/scene/yaml/config_node.h"
#include "render/resolved_scene.h"

namespace uw {

/// What the editor knows of a lamp besides its description.
struct EditedLamp {
    /// The index of its entry in the file's list; none: a glTF file provides it.
    std::optional<std::size_t> entry;
    /// What its light looks like but for its brightness: where it is the same, and so is
    /// EditedScene::surrounding, the images of the lamp are multiples of each other.
    std::string key;
    Spectrum brightness;  // Lamp::axis_intensity: per band on the axis [W/sr]
    bool on = true;
};

/// A scene as it is after a change, never changed itself.
struct EditedScene {
    explicit EditedScene(ResolvedScene resolved) : scene(std::move(resolved)) {}

    std::int64_t revision = 0;
    ResolvedScene scene;
    std::vector<EditedLamp> lamps;  // of `scene`, in their order
    std::string surrounding;        // identifies all but the lamps
    bool has_plain_colour = true;   // R, G and B are the three bands
    std::shared_ptr<const Camera> camera;
    std::vector<std::string> warnings;

    std::size_t bands() const { return scene.desc().water.bands_nm.size(); }
    /// The lamp of this name; none if there is none.
    std::optional<std::size_t> find_lamp(std::string_view name) const;
    /// What the three planes of a lamp's image are multiplied by when its brightness per band is
    /// `brightness` instead of 1: with plain colour the bands, else the brightest band thrice.
    std::array<double, 3> colour_scale(const Spectrum& brightness) const;
};

/// Reads a scene from the text of its file, as parsed; `off` are the names of lamps that are off.
/// Throws as load_scene_text, ResolvedScene and make_lamp.
std::shared_ptr<const EditedScene> make_edited_scene(std::string_view text, const ConfigNode& tree,
                                                     const std::filesystem::path& file,
                                                     const std::vector<std::string>& off,
                                                     std::int64_t revision);

}  // namespace uw
