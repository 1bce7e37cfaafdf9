#pragma once

#include "core/scene/camera_desc.h"
#include "core/scene/yaml/config_value.h"
#include "core/scene/yaml/scene_context.h"

namespace uw {

/// Readers for what calibration files know of a camera, too: its resolution and its port. All throw
/// InputError at the value.

/// Sets the resolution [pixels]; `both` is the location of the pair, for messages.
void read_resolution(const ConfigValue& both, const ConfigValue& width, const ConfigValue& height,
                     CameraDesc& camera);

/// `port` of a camera.
PortDesc read_port(const ConfigValue& value, const SceneContext& context);

/// A refractive index.
double read_refractive_index(const ConfigValue& value);

/// Checks that the glass lies in front of the camera; `normal` is unit.
void check_port_normal(const ConfigValue& at, const Vector3& normal);

/// Checks that the camera is inside its dome.
void check_dome(const ConfigValue& at, const DomePortDesc& dome);

}  // namespace uw
