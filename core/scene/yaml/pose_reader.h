#pragma once

#include "core/base/affine.h"
#include "core/scene/yaml/config_value.h"

namespace uw {

/// The rigid `pose` of a camera or a rig, as world_from_camera.
Affine read_pose(const ConfigValue& value);

/// `transform: {scale, rotate, translate}` of a volume or mesh as translate * rotate * scale.
Affine read_transform(const ConfigValue& value);

}  // namespace uw
