#pragma once

#include "core/light/lamp.h"
#include "core/scene/scene_desc.h"

/// Suns over the scenes of tests, in whose world y points down: the water begins at y = -3.
namespace uw::test {

inline const WaterSurfaceDesc k_sea_level{{0, -3, 0}, {0, -1, 0}};

/// A slanting sun, brighter in each band than in the one before.
inline LampDesc slanting_sun(double angle = 0, int samples = 32) {
    LampDesc lamp;
    lamp.name = "sun";
    lamp.direction = glm::normalize(Vector3(0.5, 1, 0.3));
    lamp.sun = SunDesc{angle, samples, k_sea_level};
    lamp.intensity = PerBand{1, 2, 3};
    lamp.fixed_to_camera = false;
    return lamp;
}

}  // namespace uw::test
