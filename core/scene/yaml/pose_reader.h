#pragma once

#include "core/base/affine.h"
#include "core/scene/yaml/config_map.h"
#include "core/scene/yaml/config_value.h"

namespace uw {

/// `pose`, a view, position and rotation, or matrix: world_from_camera, rigid.
Affine read_pose(const ConfigValue& value);

/// The same from the keys `position`, `look_at` and `up`, `rotate`, or `matrix` of `map`, of which
/// all others must have been read. `is_view`: one of look_at, rotate and matrix is required; else
/// the axes are those of the world without them.
Affine read_pose_keys(ConfigMap& map, bool is_view);

/// `transform`, scale then rotate then translate: world_from_object.
Affine read_transform(const ConfigValue& value);

}  // namespace uw
