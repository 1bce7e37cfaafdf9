#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/scene/scene_desc.h"

namespace uw {

/// The camera of a rig that --camera names, by its index. Throws UsageError that names those there
/// are.
std::size_t camera_called(const std::string& name, const std::vector<RigCameraDesc>& cameras);

/// The one camera that a command works with: the scene's own if it has no rig, else the one named,
/// which must be named unless it is the only one. Throws UsageError.
std::size_t chosen_camera(const std::string& name, const std::vector<RigCameraDesc>& cameras);

}  // namespace uw
