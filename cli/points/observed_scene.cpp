#include "cli/points/observed_scene.h"

#include <fmt/format.h>

#include "camera/image_size.h"
#include "cli/camera_choice.h"
#include "cli/console.h"
#include "render/scene_loading.h"

namespace uw {

ResolvedScene observed_scene(const PointsArguments& a) {
    SceneDesc desc = load_scene(a.scene, a.overrides);
    desc.volumes.clear();
    if (a.size) resize_images(desc, (*a.size)[0], (*a.size)[1]);
    ResolvedScene scene(scene_of_image(desc, {a.frame, chosen_camera(a.camera, desc.cameras)}));
    scene.edit().lamps.clear();
    return scene;
}

AssembledScene with_surfaces(const ResolvedScene& scene) {
    AssembledScene assembled = assemble_scene(scene.desc(), [](const std::string& /*stage*/) {});
    for (const std::string& warning : assembled.geometry_warnings)
        print_message(fmt::format("warning: {}\n", warning));
    return assembled;
}

}  // namespace uw
