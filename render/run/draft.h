#pragma once

#include <limits>

#include "core/scene/camera_desc.h"
#include "render/image_scene.h"

namespace uw {

/// Gives a camera the same view in an image at most this wide [pixels], with sides in proportion
/// but for a height of more than `max_height`.
void shrink_image(CameraDesc& camera, int max_width,
                  int max_height = std::numeric_limits<int>::max());

/// The scene of a small, quickly rendered picture of the same view: draft quality, as many samples
/// as the drafts of its integrator have, and the size of shrink_image.
ImageScene draft_of(const ImageScene& scene, int max_width,
                    int max_height = std::numeric_limits<int>::max());

}  // namespace uw
