#pragma once

#include <string>
#include <string_view>

#include "core/motion/files/pose_file.h"

namespace uw {

/// nerfstudio's transforms.json, as read_pose_file says; `origin` names the scene entry and the
/// file in messages.
PoseFile read_nerfstudio(std::string_view text, const std::string& origin);

}  // namespace uw
