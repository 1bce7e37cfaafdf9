#pragma once

#include "core/scene/scene_desc.h"

namespace uw {

/// The largest coordinate of a camera, lamp, shape or volume and the largest length of a part of a
/// camera [m]. Rays are traced in single precision, which resolves 1 m out there; products of four
/// such numbers are still far from its largest, 3e38.
inline constexpr double k_largest_coordinate = 1e7;
/// The largest tangent of the angle between a ray of the image and the optical axis: 89.99 degrees.
inline constexpr double k_largest_slope = 1e4;
/// The smallest width of a pixel, as such a tangent: single precision does not tell narrower ones
/// apart.
inline constexpr double k_narrowest_pixel = 1e-9;
/// The narrowest beam of a lamp [degrees].
inline constexpr double k_narrowest_beam = 0.01;
/// The greatest angle in the water between any light of a sun and the normal of the water's surface
/// [degrees].
inline constexpr double k_lowest_sun = 89;
/// The largest intensity [W/sr], power [W] or flux [lm] of a lamp.
inline constexpr double k_largest_brightness = 1e12;
/// The largest concentration [ppm] or coefficient [1/m] per unit of a grid's value.
inline constexpr double k_largest_per_unit = 1e12;
/// The smallest and largest number of a sensor or of snow that is not 0: no real one is beyond, and
/// single precision holds their products.
inline constexpr double k_least_number = 1e-12, k_largest_number = 1e12;

/// Throws InputError "<where>: <what>; <mend>" for the first quantity of a resolved scene, wherever
/// it comes from, that is not finite or beyond what rays can be traced with: the limits above. What
/// the files of surfaces and volumes hold is checked where it is loaded.
void check_limits(const SceneDesc& scene);

}  // namespace uw
