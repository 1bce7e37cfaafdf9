#pragma once

#include <memory>
#include <vector>

#include "core/base/ray.h"
#include "core/json/json.h"
#include "core/scene/yaml/config_node.h"
#include "edit/session/edited_scene.h"
#include "edit/session/scene_outlines.h"

namespace uw {

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
