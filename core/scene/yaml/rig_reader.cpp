#include "core/scene/yaml/rig_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/scene/yaml/camera_reader.h"
#include "core/scene/yaml/config_map.h"
#include "core/scene/yaml/name_reader.h"
#include "core/scene/yaml/pose_reader.h"

namespace uw {
namespace {

RigCameraDesc read_rig_camera(const ConfigValue& value, const SceneContext& context) {
    constexpr auto k_mend = "name the camera, such as left";
    const ConfigNode* const name = value.node().find("name");
    if (name == nullptr) value.fail(fmt::format("'name' is missing; {}", k_mend));
    RigCameraDesc camera;
    camera.name =
        read_short_name(ConfigValue(*name, value.path() + ".name"), "a file's name", k_mend);
    // The rest is a camera like that of a single-camera scene.
    ConfigNode unnamed = value.node();
    std::erase_if(unnamed.entries, [](const auto& entry) { return entry.key == "name"; });
    camera.camera = read_camera(ConfigValue(unnamed, value.path()), context);
    return camera;
}

}  // namespace

std::vector<RigCameraDesc> read_cameras(const ConfigValue& value,
                                        const std::optional<ConfigValue>& rig,
                                        SceneContext& context) {
    Affine world_from_rig;
    if (rig) {
        constexpr auto k_mend = "write rig: {pose: {position: [0, 0, 0], look_at: [0, 0, 1]}}";
        ConfigMap map(*rig, {"pose"}, k_mend);
        world_from_rig = read_pose(map.require("pose", k_mend));
    }
    std::vector<RigCameraDesc> cameras;
    for (const ConfigValue& entry : value.list("write one '- {name: left, ...}' per camera")) {
        RigCameraDesc camera = read_rig_camera(entry, context);
        if (std::ranges::find(cameras, camera.name, &RigCameraDesc::name) != cameras.end())
            entry.fail(fmt::format("the name '{}' is taken by another camera; give each its own",
                                   camera.name));
        camera.camera.world_from_camera = world_from_rig * camera.camera.world_from_camera;
        cameras.push_back(std::move(camera));
    }
    if (cameras.empty()) value.fail("is empty; write one '- {name: left, ...}' per camera");
    context.rig = {world_from_rig, cameras.front().camera.world_from_camera};
    return cameras;
}

}  // namespace uw
