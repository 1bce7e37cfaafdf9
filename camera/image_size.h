#pragma once

#include "core/scene/scene_desc.h"

namespace uw {

/// Changes the camera's resolution but not its view: the intrinsics [pixels] are scaled with it,
/// and the time from row to row, so that all rows take as long as before.
/// `width`, `height` >= 1.
inline void resize_image(CameraDesc& camera, int width, int height) {
    const double sx = static_cast<double>(width) / camera.width;
    const double sy = static_cast<double>(height) / camera.height;
    const IntrinsicsDesc& k = camera.intrinsics;
    camera.intrinsics = {k.fx * sx, k.fy * sy, k.cx * sx, k.cy * sy};
    camera.line_time /= sy;
    camera.width = width;
    camera.height = height;
}

/// The same for every camera of a scene.
inline void resize_images(SceneDesc& scene, int width, int height) {
    resize_image(scene.camera, width, height);
    for (RigCameraDesc& entry : scene.cameras) resize_image(entry.camera, width, height);
}

}  // namespace uw
