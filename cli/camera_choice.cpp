#include "cli/camera_choice.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

namespace {

std::string names_of(const std::vector<RigCameraDesc>& cameras) {
    std::string names;
    for (const RigCameraDesc& camera : cameras) names += (names.empty() ? "" : ", ") + camera.name;
    return names;
}

}  // namespace

std::size_t camera_called(const std::string& name, const std::vector<RigCameraDesc>& cameras) {
    if (cameras.empty())
        throw UsageError(fmt::format(
            "--camera {}: the scene has one camera, which has no name; leave the option out",
            printable(name)));
    const auto found = std::ranges::find(cameras, name, &RigCameraDesc::name);
    if (found == cameras.end())
        throw UsageError(fmt::format("--camera: the scene has no camera '{}'; it has {}",
                                     printable(name), names_of(cameras)));
    return static_cast<std::size_t>(found - cameras.begin());
}

std::size_t chosen_camera(const std::string& name, const std::vector<RigCameraDesc>& cameras) {
    if (!name.empty()) return camera_called(name, cameras);
    if (cameras.size() > 1)
        throw UsageError(
            fmt::format("--camera: the scene has several; choose one of {}", names_of(cameras)));
    return 0;
}

}  // namespace uw
