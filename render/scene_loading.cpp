#include "render/scene_loading.h"

#include "camera/calibration/calibration.h"
#include "core/meshes/gltf/gltf_time_range.h"
#include "core/motion/files/trajectory_loading.h"
#include "core/scene/variations/variations_reader.h"
#include "core/scene/yaml/config_node.h"
#include "core/scene/yaml/scene_reader.h"

namespace uw {

namespace {

void add_to_hash(const std::string& hash, SceneDesc& scene) {
    ConfigNode both;
    both.kind = ConfigNode::Kind::scalar;
    both.quoted = true;
    both.scalar = scene.hash + hash;
    scene.hash = config_hash(both);
}

// Reads the calibration file that `camera` names, if any, into it.
void calibrate(CameraDesc& camera, SceneDesc& scene) {
    const auto calibration = apply_calibration(camera);
    if (!calibration) return;
    scene.warnings.insert(scene.warnings.end(), calibration->warnings.begin(),
                          calibration->warnings.end());
    add_to_hash(calibration->hash, scene);
}

// Makes the trajectories, reading their files, and looks for animations.
void set_in_motion(SceneDesc& scene) {
    const auto load = [&](std::optional<TrajectoryDesc>& desc) {
        if (!desc) return;
        const std::string hash = load_trajectory(*desc, scene.render.fps);
        if (!hash.empty()) add_to_hash(hash, scene);
    };
    load(scene.camera.trajectory);
    load(scene.rig_trajectory);
    for (LampDesc& lamp : scene.lamps) load(lamp.trajectory);
    for (GeometryDesc& geometry : scene.geometry) {
        load(geometry.trajectory);
        const std::string extension = geometry.file.extension().string();
        if (!geometry.is_sequence && (extension == ".gltf" || extension == ".glb"))
            geometry.animation = gltf_time_range(geometry.file);
    }
}

SceneDesc complete(SceneDesc scene) {
    set_in_motion(scene);
    if (scene.cameras.empty()) {
        calibrate(scene.camera, scene);
        return scene;
    }
    for (RigCameraDesc& entry : scene.cameras) calibrate(entry.camera, scene);
    scene.camera = scene.cameras.front().camera;
    return scene;
}

}  // namespace

SceneDesc load_scene_tree(const ConfigNode& tree, const std::filesystem::path& file,
                          const SceneArrays* arrays) {
    return complete(scene_of_tree(tree, file, arrays));
}

SceneDesc load_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    const ConfigNode tree = read_scene_tree(file, overrides);
    read_variations(tree, file);
    return load_scene_tree(tree, file);
}

SceneDesc load_scene_text(std::string_view text, const std::filesystem::path& file) {
    const ConfigNode tree = scene_tree(text, file);
    read_variations(tree, file);
    return load_scene_tree(tree, file);
}

}  // namespace uw
