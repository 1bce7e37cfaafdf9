#include "render/snow/exposure_views.h"

namespace uw {

namespace {

const TrajectoryDesc* trajectory_of(const SceneDesc& scene) {
    if (scene.rig_trajectory) return &*scene.rig_trajectory;
    return scene.camera.trajectory ? &*scene.camera.trajectory : nullptr;
}

/// Where the camera of an image moves while its shutter is open; `from` and `to` in time.
Affine moved(const Trajectory& trajectory, double from, double to, const Affine& pose) {
    return trajectory.at(to).affine() * trajectory.at(from).affine().inverse() * pose;
}

}  // namespace

std::vector<ExposureView> exposure_views(const SceneDesc& scene) {
    std::vector<ExposureView> views{{Camera(scene.camera), 0, {}}};
    const double half = 0.5 * scene.render.shutter;
    if (!(half > 0)) return views;
    const double middle = scene.time.value_or(0);
    const TrajectoryDesc* trajectory = trajectory_of(scene);
    for (const double offset : {-half, half}) {
        CameraDesc camera = scene.camera;
        if (trajectory != nullptr) {
            const Trajectory& path = *trajectory->trajectory;
            const double time = middle + offset;
            if (time < path.first_time() || time > path.last_time()) continue;
            camera.world_from_camera = moved(path, middle, time, camera.world_from_camera);
        }
        views.push_back({Camera(camera), offset,
                         scene.camera.world_from_camera * camera.world_from_camera.inverse()});
    }
    return views;
}

}  // namespace uw
