#include "render/resolved_scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/frame_pattern.h"
#include "core/base/text.h"
#include "core/meshes/gltf/gltf_import.h"
#include "core/scene/scene_limits.h"
#include "render/scene_motion.h"

namespace uw {

namespace {

void refuse_open_sequences(const SceneDesc& scene) {
    const auto refuse = [](const SourceLocation& where, const std::filesystem::path& file) {
        throw InputError(
            fmt::format("{}.file: there is no '{}', and as the name of a sequence it needs frames; "
                        "render it with --frames 1-10, or name one file",
                        where, printable(file.string(), 300)));
    };
    for (const VolumeDesc& volume : scene.volumes) {
        if (volume.is_sequence) refuse(volume.where, volume.file);
        if (volume.motion && volume.motion->is_sequence)
            refuse(volume.motion->where, volume.motion->file);
    }
    for (const GeometryDesc& geometry : scene.geometry)
        if (geometry.is_sequence) refuse(geometry.where, geometry.file);
}

// Sets camera and files; a scene without a choice of either keeps its own.
void choose(SceneDesc& scene, const ImageChoice& choice) {
    scene.choice = choice;
    if (!scene.cameras.empty()) {
        scene.camera = scene.cameras[choice.camera].camera;
        scene.camera_name = scene.cameras[choice.camera].name;
    }
    if (!choice.frame) return;
    const auto choose_file = [&](auto& input) {
        if (!input.is_sequence) return;
        input.file = file_of_frame(input.file, *choice.frame);
        input.is_sequence = false;
    };
    for (VolumeDesc& volume : scene.volumes) {
        choose_file(volume);
        if (volume.motion) choose_file(*volume.motion);
    }
    std::ranges::for_each(scene.geometry, choose_file);
}

}  // namespace

SceneDesc scene_of_image(const SceneDesc& scene, const ImageChoice& choice) {
    SceneDesc result = scene;
    result.whole = std::make_shared<SceneDesc>(scene);
    choose(result, choice);
    if (!has_motion(scene)) return result;
    if (choice.frame)
        set_time(result, time_of_frame(scene, *choice.frame),
                 fmt::format("frame {}", *choice.frame));
    else
        set_time(result, first_time(scene), "the first moment");
    return result;
}

SceneDesc scene_at(const SceneDesc& scene, double time) {
    SceneDesc then = *scene.whole;
    choose(then, scene.choice);
    set_time_of_exposure(then, time);
    import_gltf(then);
    SceneDesc result = scene;
    result.time = time;
    result.camera.world_from_camera = then.camera.world_from_camera;
    for (std::size_t i = 0; i < result.geometry.size(); ++i) {
        result.geometry[i].world_from_object = then.geometry[i].world_from_object;
        result.geometry[i].time = then.geometry[i].time;
    }
    // An image may have fewer lamps than its scene.
    for (LampDesc& lamp : result.lamps) {
        const auto moved = std::ranges::find(then.lamps, lamp.name, &LampDesc::name);
        if (moved == then.lamps.end()) continue;
        lamp.position = moved->position;
        lamp.direction = moved->direction;
        lamp.world_from_mount = moved->world_from_mount;
    }
    return result;
}

ResolvedScene::ResolvedScene(SceneDesc&& scene) : desc_(std::move(scene)) {
    refuse_open_sequences(desc_);
    if (!desc_.time && has_motion(desc_)) {
        desc_.whole = std::make_shared<SceneDesc>(desc_);
        set_time(desc_, first_time(desc_), "the first moment");
    }
    import_gltf(desc_);
    check_limits(desc_);
}

}  // namespace uw
