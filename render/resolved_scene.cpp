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

}  // namespace

SceneDesc scene_of_image(const SceneDesc& scene, const ImageChoice& choice) {
    SceneDesc result = scene;
    result.whole = std::make_shared<SceneDesc>(scene);
    result.choice = choice;
    if (!scene.cameras.empty()) {
        result.camera = scene.cameras[choice.camera].camera;
        result.camera_name = scene.cameras[choice.camera].name;
    }
    if (!choice.frame) {
        if (has_motion(scene)) set_time(result, first_time(scene), "the first moment");
        return result;
    }
    if (has_motion(scene))
        set_time(result, time_of_frame(scene, *choice.frame),
                 fmt::format("frame {}", *choice.frame));
    const auto choose = [&](auto& input) {
        if (!input.is_sequence) return;
        input.file = file_of_frame(input.file, *choice.frame);
        input.is_sequence = false;
    };
    for (VolumeDesc& volume : result.volumes) {
        choose(volume);
        if (volume.motion) choose(*volume.motion);
    }
    std::ranges::for_each(result.geometry, choose);
    return result;
}

ResolvedScene::ResolvedScene(SceneDesc&& scene) : desc_(std::move(scene)) {
    refuse_open_sequences(desc_);
    if (!desc_.time && has_motion(desc_)) set_time(desc_, first_time(desc_), "the first moment");
    import_gltf(desc_);
    check_limits(desc_);
}

}  // namespace uw
