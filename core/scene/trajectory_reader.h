#pragma once

#include "core/base/vector_math.h"
#include "core/scene/config_value.h"
#include "core/scene/scene_context.h"
#include "core/scene/trajectory.h"

namespace uw {

/// `pose`, a view, position and rotation, or matrix: world_from_camera, rigid.
Affine read_pose(const ConfigValue& value);

/// The same where no view is needed: without `look_at`, `rotate` and `matrix` the axes are those of
/// what it is in.
Affine read_placed_pose(const ConfigValue& value);

/// `transform`, scale then rotate then translate: world_from_object.
Affine read_transform(const ConfigValue& value);

/// A `trajectory`: keyframes, or the file that has the poses, which is not read. `is_view`: of
/// something that looks, whose keyframes need a direction.
TrajectoryDesc read_trajectory(const ConfigValue& value, const SceneContext& context, bool is_view);
}  // namespace uw
