#include "render/correspondences.h"

#include <fmt/format.h>

#include <algorithm>

#include "camera/camera.h"
#include "core/base/error.h"
#include "render/exposure.h"
#include "render/image_scene.h"
#include "render/scene_cache.h"
#include "render/view_matcher.h"

namespace uw {

namespace {

/// With a rolling shutter, points on moving surfaces would have to be found at the different times
/// of the rows.
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

/// Returns the frame `step` later, with an image of the same size; none if there is no such frame.
std::optional<ImageScene> neighbour(const ImageScene& scene, int step) {
    const std::optional<ImageScene> other = scene.neighbour(step);
    if (!other) return std::nullopt;
    const CameraDesc& camera = scene.desc().camera;
    return other->with(
        [&](SceneDesc& desc) { resize_image(desc.camera, camera.width, camera.height); });
}

std::shared_ptr<const Surfaces> surfaces_of(const SceneDesc& next, const AssembledScene& scene,
                                            SceneCache& cache) {
    if (next.geometry == scene.desc().geometry) return scene.surfaces;
    return cache.surfaces_ahead(next).surfaces;
}

}  // namespace

Correspondences::Correspondences(const AssembledScene& scene, const LayerPlan& plan,
                                 SceneCache& cache) {
    const SceneDesc& now = scene.desc();
    for (const LayerKind& kind : k_layers)
        if (kind.content == LayerContent::match && plan.has(kind.layer))
            refuse_rolling_surfaces(now);
    const bool finds_occluded = plan.has(Layer::flow_occluded);
    const auto motions_until = [&](const SceneDesc& then) {
        return object_motions(now, then, scene.surfaces->names(), warnings_);
    };
    if (plan.has(Layer::flow) || finds_occluded) {
        if (const auto next = neighbour(scene.image, 1))
            next_.emplace(camera_of_truth(*next), scene.surfaces, motions_until(next->desc()),
                          finds_occluded ? surfaces_of(next->desc(), scene, cache) : nullptr);
    }
    if (plan.has(Layer::plume_flow)) {
        if (const auto next = neighbour(scene.image, 1))
            plume_.emplace(scene, camera_of_truth(*next), 1 / now.render.fps);
    }
    if (plan.has(Layer::flow_back)) {
        if (const auto previous = neighbour(scene.image, -1))
            previous_.emplace(camera_of_truth(*previous), scene.surfaces,
                              motions_until(previous->desc()), nullptr);
    }
    if (!plan.has(Layer::disparity) && !plan.has(Layer::disparity_occluded)) return;
    if (now.cameras.size() < 2) return;
    is_first_camera_ = scene.image.choice().camera == 0;
    other_camera_.emplace(camera_of_truth(scene.image.seen_by(is_first_camera_ ? 1 : 0)),
                          scene.surfaces, ObjectMotions(), scene.surfaces);
}

PointMatchers Correspondences::matchers() const {
    const auto pointer = [](const std::optional<ViewMatcher>& matcher) {
        return matcher ? &*matcher : nullptr;
    };
    return {pointer(next_), pointer(previous_), pointer(other_camera_), plume_ ? &*plume_ : nullptr,
            is_first_camera_};
}

}  // namespace uw
