#pragma once

#include <cstddef>

#include "camera/camera.h"
#include "core/scene/camera_desc.h"
#include "python/arguments.h"

namespace uw {

/// A camera by itself, and what it was made of.
struct CameraObject {
    CameraDesc desc;
    Camera camera;
};

/// The camera of a description alone: of a calibration, at the world's origin.
inline CameraObject camera_of(const CameraDesc& desc) {
    return {desc, Camera(desc)};
}

}  // namespace uw

UWVDB_BOUND_CLASS(uw::CameraObject);
