#pragma once

#include "core/scene/camera_desc.h"
#include "core/scene/yaml/config_value.h"

namespace uw {

/// What scenes and calibration files have in common: values of a camera, checked. All throw
/// InputError at the value.

/// Sets the resolution [pixels]; `both` is the place of it as a whole.
void read_resolution(const ConfigValue& both, const ConfigValue& width, const ConfigValue& height,
                     CameraDesc& camera);

/// A refractive index.
double read_refractive_index(const ConfigValue& value);

/// That the glass lies before the camera: `normal` is unit.
void check_port_normal(const ConfigValue& at, const Vector3& normal);

/// That the camera is in its dome.
void check_dome(const ConfigValue& at, const DomePortDesc& dome);

}  // namespace uw
