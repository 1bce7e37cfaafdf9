#pragma once

#include "core/base/vector_math.h"
#include "core/scene/config_value.h"
#include "core/scene/scene_context.h"
#include "core/scene/trajectory.h"

namespace uw {

/// `pose`, a view, position and rotation, or matrix: world_from_camera, rigid.
Affine read_pose(const ConfigValue& value);

/// The same from the keys `position`, `look_at` and `up`, `rotate`, or `matrix` of `map`, of which
/// all others must have been read. `is_view`: one of look_at, rotate and matrix is required; else
/// the axes are those of the world without them.
Affine read_pose_keys(ConfigMap& map, bool is_view);

/// `transform`, scale then rotate then translate: world_from_object.
Affine read_transform(const ConfigValue& value);

/// A `trajectory`: keyframes, or the file that has the poses, which is not read. `is_view`: of
/// something that looks, whose keyframes need a direction.
TrajectoryDesc read_trajectory(const ConfigValue& value, const SceneContext& context, bool is_view);

}  // namespace uw
