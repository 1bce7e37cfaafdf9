#include "dataset/set/point_seeds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "camera/camera.h"
#include "render/resolved_scene.h"

namespace uw {

namespace {

bool is_still(const GeometryDesc& geometry) {
    return !geometry.trajectory && !geometry.animation && !geometry.is_sequence;
}

}  // namespace

ImageChoice choice_of(const DatasetDefinition& definition, const SceneDesc& scene,
                      const View& view) {
    const auto camera =
        std::ranges::find(scene.cameras, definition.cameras[view.camera], &RigCameraDesc::name);
    const bool is_of_rig = camera != scene.cameras.end();
    return {definition.frames[view.frame],
            is_of_rig ? static_cast<std::size_t>(camera - scene.cameras.begin()) : 0};
}

std::vector<SurfacePoint> point_seeds(const DatasetDefinition& definition, std::size_t draw,
                                      const SceneDesc& scene, const Surfaces& surfaces) {
    constexpr std::size_t k_most_views = 64;
    const std::size_t all = definition.frames.size() * definition.cameras.size();
    const std::size_t views = std::min(all, k_most_views);
    const auto side = static_cast<int>(
        std::sqrt(static_cast<double>(k_most_points) / static_cast<double>(views)));
    SceneDesc without_light = scene;  // which is not needed, and takes time to read
    without_light.volumes.clear();
    std::vector<SurfacePoint> points;
    for (std::size_t i = 0; i < views; ++i) {
        const View view = definition.view(draw * all + i * all / views);
        const ResolvedScene resolved(
            scene_of_image(without_light, choice_of(definition, scene, view)));
        const Camera camera(resolved.desc().camera);
        for (int row = 0; row < side; ++row)
            for (int column = 0; column < side; ++column) {
                const auto ray = camera.refracted_ray((column + 0.5) / side * camera.width(),
                                                      (row + 0.5) / side * camera.height());
                SurfaceHit hit;
                if (!ray ||
                    !surfaces.closest_hit(*ray, std::numeric_limits<double>::infinity(), hit))
                    continue;
                const SurfaceName& object = surfaces.names().objects[hit.object_id - 1];
                if (is_still(scene.geometry[object.entry])) points.push_back({hit.position});
            }
    }
    return points;
}

}  // namespace uw
