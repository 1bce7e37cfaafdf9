#include "render/scene_loading.h"

#include "camera/calibration/calibration.h"
#include "core/scene/yaml/config_node.h"
#include "core/scene/yaml/scene_reader.h"

namespace uw {

namespace {

// Reads the calibration file that `camera` names, if any, into it.
void calibrate(CameraDesc& camera, SceneDesc& scene) {
    const auto calibration = apply_calibration(camera);
    if (!calibration) return;
    scene.warnings.insert(scene.warnings.end(), calibration->warnings.begin(),
                          calibration->warnings.end());
    ConfigNode both;
    both.kind = ConfigNode::Kind::scalar;
    both.quoted = true;
    both.scalar = scene.hash + calibration->hash;
    scene.hash = config_hash(both);
}

SceneDesc calibrated(SceneDesc scene) {
    if (scene.cameras.empty()) {
        calibrate(scene.camera, scene);
        return scene;
    }
    for (RigCameraDesc& entry : scene.cameras) calibrate(entry.camera, scene);
    scene.camera = scene.cameras.front().camera;
    return scene;
}

}  // namespace

SceneDesc load_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    return calibrated(read_scene(file, overrides));
}

SceneDesc load_scene_text(std::string_view text, const std::filesystem::path& file) {
    return calibrated(read_scene_text(text, file));
}

}  // namespace uw
