#pragma once

#include <vector>

#include "camera/camera.h"
#include "core/scene/scene_desc.h"

namespace uw {

/// A camera at one moment of an exposure.
struct ExposureView {
    Camera camera;
    double time = 0;            // from the middle of the exposure [s]
    Affine middle_from_moment;  // takes what it sees to where that is seen in the middle
};

/// The camera of a resolved scene when the shutter opens, in the middle and when it closes; in the
/// middle alone without a shutter (RenderDesc::shutter), and without the ends that its trajectory
/// does not reach. The middle is the first.
std::vector<ExposureView> exposure_views(const SceneDesc& scene);

}  // namespace uw
