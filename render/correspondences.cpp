#include "render/correspondences.h"

#include <fmt/format.h>

#include <algorithm>

#include "camera/camera.h"
#include "core/base/error.h"
#include "core/geometry/geometry_scene.h"
#include "render/exposure.h"
#include "render/resolved_scene.h"
#include "render/view_matcher.h"

namespace uw {

namespace {

/// Where a row's exposure differs from another's, points on what moves would have to be looked for
/// at many times.
void refuse_rolling_surfaces(const SceneDesc& scene) {
    const auto moves = [](const GeometryDesc& geometry) {
        return geometry.trajectory || geometry.animation;
    };
    const auto entry = std::ranges::find_if(scene.geometry, moves);
    if (scene.camera.line_time == 0 || entry == scene.geometry.end()) return;
    throw InputError(fmt::format(
        "{}.line_time: with a rolling shutter there is no flow or disparity of a scene in which "
        "surfaces move ({}); leave out their layers, or line_time",
        scene.camera.where, entry->where));
}

/// The frame `step` later, with an image of this scene's size; none if there is none.
std::optional<SceneDesc> neighbour(const SceneDesc& scene, int step) {
    if (!scene.whole || !scene.choice.frame) return std::nullopt;
    const int frame = *scene.choice.frame + step;
    if (!has_frame(*scene.whole, frame)) return std::nullopt;
    ResolvedScene resolved(scene_of_image(*scene.whole, {frame, scene.choice.camera}));
    SceneDesc desc = std::move(resolved).release();
    resize_image(desc.camera, scene.camera.width, scene.camera.height);
    return desc;
}

/// The camera of the same moment that is another of the rig.
Camera other_camera(const SceneDesc& scene, std::size_t index) {
    SceneDesc other = scene;
    other.camera = scene.cameras[index].camera;
    other.choice.camera = index;
    return camera_of_truth(other);
}

std::shared_ptr<const Surfaces> surfaces_of(const SceneDesc& next, const AssembledScene& scene,
                                            SurfacesAhead& ahead) {
    if (next.geometry == scene.desc.geometry) return scene.surfaces;
    if (!ahead.are_of(next)) {
        ahead = {next.geometry, next.water.bands_nm, nullptr, {}};
        ahead.surfaces =
            build_surfaces(next.geometry, next.water.bands_nm, ahead.warnings, *scene.meshes);
    }
    return ahead.surfaces;
}

}  // namespace

Correspondences::Correspondences(const AssembledScene& scene, const LayerPlan& plan,
                                 SurfacesAhead& ahead) {
    const SceneDesc& now = scene.desc;
    for (const LayerKind& kind : k_layers)
        if (kind.content == LayerContent::match && plan.has(kind.layer))
            refuse_rolling_surfaces(now);
    const bool finds_occluded = plan.has(Layer::flow_occluded);
    const auto motions_until = [&](const SceneDesc& then) {
        return object_motions(now, then, scene.surfaces->names(), warnings_);
    };
    if (plan.has(Layer::flow) || finds_occluded) {
        if (const auto next = neighbour(now, 1))
            next_.emplace(camera_of_truth(*next), motions_until(*next),
                          finds_occluded ? surfaces_of(*next, scene, ahead) : nullptr);
    }
    if (plan.has(Layer::flow_back)) {
        if (const auto previous = neighbour(now, -1))
            previous_.emplace(camera_of_truth(*previous), motions_until(*previous), nullptr);
    }
    if (!plan.has(Layer::disparity) && !plan.has(Layer::disparity_occluded)) return;
    if (now.cameras.size() < 2) return;
    is_first_camera_ = now.choice.camera == 0;
    other_camera_.emplace(other_camera(now, is_first_camera_ ? 1 : 0), ObjectMotions(),
                          scene.surfaces);
}

PointMatchers Correspondences::matchers() const {
    const auto pointer = [](const std::optional<ViewMatcher>& matcher) {
        return matcher ? &*matcher : nullptr;
    };
    return {pointer(next_), pointer(previous_), pointer(other_camera_), is_first_camera_};
}

}  // namespace uw
