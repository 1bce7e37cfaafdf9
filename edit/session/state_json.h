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

/// Edges by which the shapes of a scene can be recognised in a plan. A mesh has those at its rims
/// and where faces meet at more than 30 degrees, a box all, a sphere three great circles, and a
/// plane, which has no end, none. If there are more than `most`, the longest are kept. A mesh that
/// cannot be read has none: rendering reports that.
std::vector<OutlineSegment> scene_outlines(const std::vector<GeometryDesc>& geometry,
                                           std::size_t most = 20000);

/// Data about a scene once it has been assembled.
struct SceneShapes {
    std::vector<OutlineSegment> outlines;
    std::vector<Bounds> volumes;  // world; one per volume, perhaps empty
};

Json outline_segments_json(const std::vector<OutlineSegment>& outlines);

/// The parts of the state (docs/edit-api.md) that describe the scene: "image", "camera", "lamps",
/// "water", "volumes" and so on. `tree` is the scene file's; `shapes` may be null.
Json scene_json(const EditedScene& edited, const ConfigNode& tree, const SceneShapes* shapes);

}  // namespace uw
