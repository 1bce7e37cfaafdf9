#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/image/layers.h"
#include "render/scene_assembly.h"
#include "render/view_matcher.h"

namespace uw {

/// Where the points of an image are in the next and the previous frame and in another camera of the
/// rig, as far as layers about that are in the image.
///
/// Neighbours are the frames with the numbers one higher and one lower, made of the scene as it was
/// read (ImageScene::whole). There is none before frame 0 and where a trajectory has no pose. Of a
/// rig the other camera is the second for the first, and the first for all others.
class Correspondences {
  public:
    /// `scene` outlives this. Surfaces of the next frame are `scene`'s if nothing of them moves,
    /// else those that `cache` keeps ahead. Throws as ImageScene, build_surfaces and
    /// object_motions.
    Correspondences(const AssembledScene& scene, const LayerPlan& plan, SceneCache& cache);

    PointMatchers matchers() const;
    const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    std::optional<ViewMatcher> next_, previous_, other_camera_;
    bool is_first_camera_ = true;
    std::vector<std::string> warnings_;
};

}  // namespace uw
