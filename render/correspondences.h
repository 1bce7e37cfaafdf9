#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/image/layers.h"
#include "render/plume_motion.h"
#include "render/scene_assembly.h"
#include "render/view_matcher.h"

namespace uw {

/// Finds the points of an image in the next and the previous frame and in another camera of the
/// rig, as far as the image's layers require it.
///
/// Neighbours are the next and the previous frame, made from the scene as it was read
/// (ImageScene::whole). There is none before frame 0 and where a trajectory has no pose. The other
/// camera of a rig is the second one for the first camera, and the first one for all others.
class Correspondences {
  public:
    /// `scene` must outlive this object. The surfaces of the next frame are those of `scene` if
    /// none of them moves; otherwise `cache` builds them ahead. Throws as ImageScene,
    /// build_surfaces, object_motions and VolumeVelocity.
    Correspondences(const AssembledScene& scene, const LayerPlan& plan, SceneCache& cache);

    PointMatchers matchers() const;
    const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    std::optional<ViewMatcher> next_, previous_, other_camera_;
    std::optional<PlumeMotion> plume_;
    bool is_first_camera_ = true;
    std::vector<std::string> warnings_;
};

}  // namespace uw
