#include "cli/scene_loading.h"

#include "camera/calibration/calibration.h"
#include "core/config_node.h"
#include "core/scene_reader.h"

namespace uw {

SceneDesc load_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    SceneDesc scene = read_scene(file, overrides);
    const auto calibration = apply_calibration(scene.camera);
    if (!calibration) return scene;
    scene.warnings.insert(scene.warnings.end(), calibration->warnings.begin(),
                          calibration->warnings.end());
    ConfigNode both;
    both.kind = ConfigNode::Kind::scalar;
    both.quoted = true;
    both.scalar = scene.hash + calibration->hash;
    scene.hash = config_hash(both);
    return scene;
}

}  // namespace uw
