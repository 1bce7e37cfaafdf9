#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/base/json.h"
#include "core/base/ray.h"
#include "core/scene/geometry_desc.h"
#include "core/scene/yaml_document.h"
#include "edit/session/edited_scene.h"

namespace uw {

/// A straight edge in the world [m].
struct OutlineSegment {
    std::array<float, 3> from{}, to{};
};

/// Edges by which the shapes of a scene can be recognised in a plan: of meshes those at their rims
/// and where faces meet at more than 30 degrees; of boxes all; of spheres three great circles; of
/// planes, which have no end, none. The longest, if there are more than `most`. Meshes that cannot
/// be read have none: rendering reports that.
std::vector<OutlineSegment> scene_outlines(const std::vector<GeometryDesc>& geometry,
                                           std::size_t most = 20000);

/// Part of a scene file as JSON, with its scalars as YAML means them: numbers, true and false, or
/// text.
Json config_json(const ConfigNode& node);

/// One lamp of the state (docs/edit-api.md): what the file says of it, where it is in the world and
/// in the image. `tree` is the scene file's.
Json lamp_json(const EditedScene& edited, std::size_t index, const ConfigNode& tree);

/// The lamp spectra that a scene can name without a file, as values of `spectrum`.
Json lamp_spectrum_names_json();

/// What is known of a scene once it has been assembled.
struct SceneShapes {
    std::vector<OutlineSegment> outlines;
    std::vector<Bounds> volumes;  // world; one per volume, perhaps empty
};

Json outline_segments_json(const std::vector<OutlineSegment>& outlines);

/// The parts of the state (docs/edit-api.md) that describe the scene: "image", "camera", "lamps",
/// "water", "volumes" and so on. `tree` is the scene file's; `shapes` may be null.
Json scene_json(const EditedScene& edited, const ConfigNode& tree, const SceneShapes* shapes);

}  // namespace uw
