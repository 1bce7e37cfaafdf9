#pragma once

#include "core/scene/scene_desc.h"

namespace uw {

/// The largest coordinate of a camera, lamp, shape or volume and the largest length of a part of a
/// camera [m]. Rays are traced in single precision, which resolves 1 m out there; products of four
/// such numbers are still far from its largest, 3e38.
inline constexpr double k_max_coordinate = 1e7;

/// Throws InputError "<where>: <what>; <hint>" for the first quantity of a resolved scene, wherever
/// it comes from, that is not finite or exceeds the limits above, within which rays can be traced.
/// The contents of surface and volume files are checked when they are loaded.
void check_limits(const SceneDesc& scene);
}  // namespace uw
