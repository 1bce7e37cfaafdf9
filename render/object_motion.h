#pragma once

#include <string>
#include <vector>

#include "core/scene/scene_desc.h"
#include "core/surfaces/surface_names.h"
#include "render/view_matcher.h"

namespace uw {

/// How the objects `names` of the scene `now` move until `then`, another of its frames: by their
/// trajectories and the animations of their files. Objects of files that are one for each frame
/// have no counterpart, of which `warnings` gets a line. Empty if nothing moves. Throws as
/// gltf_placements.
ObjectMotions object_motions(const SceneDesc& now, const SceneDesc& then, const SurfaceNames& names,
                             std::vector<std::string>& warnings);

}  // namespace uw
