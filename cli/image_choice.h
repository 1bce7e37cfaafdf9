#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene_desc.h"
#include "render/run/job.h"

namespace uw {

/// The camera of a rig that --camera names, by its index. Throws UsageError that lists the existing
/// ones.
std::size_t camera_called(const std::string& name, const std::vector<RigCameraDesc>& cameras);

/// The one camera that a command works with: the scene's own if it has no rig, else the one named,
/// which must be named unless it is the only one. Throws UsageError.
std::size_t chosen_camera(const std::string& name, const std::vector<RigCameraDesc>& cameras);

/// The numbers of frames that `text` lists: "1-10,20-40:2" is 1 to 10, and every second from 20 to
/// 40, both ends included. In the order given, each once. Throws UsageError, which names `option`
/// and what it lists, for other text, and for more than a million frames.
std::vector<int> parse_frame_list(const std::string& text, const char* option = "--frames",
                                  const char* what = "frames");

}  // namespace uw
