#include "render/correspondences.h"

#include <algorithm>

#include "camera/image_size.h"
#include "core/surfaces/geometry_scene.h"
#include "render/object_motion.h"
#include "render/resolved_scene.h"
#include "render/scene_motion.h"

namespace uw {

namespace {

/// The frame `step` later; none if there is none.
std::optional<SceneDesc> neighbour(const SceneDesc& scene, int step) {
    if (!scene.whole || !scene.choice.frame) return std::nullopt;
    const int frame = *scene.choice.frame + step;
    if (!has_frame(*scene.whole, frame)) return std::nullopt;
    ResolvedScene resolved(scene_of_image(*scene.whole, {frame, scene.choice.camera}));
    return std::move(resolved).release();
}

/// A neighbour's camera, with an image of this scene's size.
CameraDesc camera_of(const SceneDesc& neighbour, const SceneDesc& scene) {
    CameraDesc camera = neighbour.camera;
    resize_image(camera, scene.camera.width, scene.camera.height);
    return camera;
}

std::shared_ptr<const Surfaces> surfaces_of(const SceneDesc& next, const AssembledScene& scene,
                                            SurfacesAhead& ahead) {
    if (next.geometry == scene.desc.geometry) return scene.surfaces;
    if (!ahead.are_of(next)) {
        ahead = {next.geometry, next.water.bands_nm, nullptr, {}};
        ahead.surfaces = build_surfaces(next.geometry, next.water.bands_nm, ahead.warnings);
    }
    return ahead.surfaces;
}

}  // namespace

Correspondences::Correspondences(const AssembledScene& scene, const LayerPlan& plan,
                                 SurfacesAhead& ahead) {
    const SceneDesc& now = scene.desc;
    const bool finds_occluded = plan.has(Layer::flow_occluded);
    const auto motions_until = [&](const SceneDesc& then) {
        return object_motions(now, then, scene.surfaces->names(), warnings_);
    };
    if (plan.has(Layer::flow) || finds_occluded) {
        if (const auto next = neighbour(now, 1))
            next_.emplace(camera_of(*next, now), motions_until(*next),
                          finds_occluded ? surfaces_of(*next, scene, ahead) : nullptr);
    }
    if (plan.has(Layer::flow_back)) {
        if (const auto previous = neighbour(now, -1))
            previous_.emplace(camera_of(*previous, now), motions_until(*previous), nullptr);
    }
    if (!plan.has(Layer::disparity) && !plan.has(Layer::disparity_occluded)) return;
    if (now.cameras.size() < 2) return;
    is_first_camera_ = now.choice.camera == 0;
    other_camera_.emplace(now.cameras[is_first_camera_ ? 1 : 0].camera, ObjectMotions(),
                          scene.surfaces);
}

PointMatchers Correspondences::matchers() const {
    const auto pointer = [](const std::optional<ViewMatcher>& matcher) {
        return matcher ? &*matcher : nullptr;
    };
    return {pointer(next_), pointer(previous_), pointer(other_camera_), is_first_camera_};
}

}  // namespace uw
