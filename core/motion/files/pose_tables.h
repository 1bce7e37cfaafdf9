#pragma once

#include <string>
#include <string_view>

#include "core/motion/files/pose_file.h"

namespace uw {

/// The formats whose poses are lines of a table, as read_pose_file says; `origin` names the scene
/// entry and the file in messages.
PoseFile read_tum(std::string_view text, const std::string& origin);
PoseFile read_euroc(std::string_view text, const std::string& origin);
PoseFile read_colmap_images(std::string_view text, const std::string& origin);

}  // namespace uw
