#pragma once

#include "core/base/spectrum.h"

namespace uw {

/// Material properties beyond diffuse reflection (SurfaceHit::reflectance).
struct SurfaceMaterial {
    Spectrum emission{};     // emitted radiance, the same in all directions [W m^-2 sr^-1]
    bool is_glossy = false;  // has a specular lobe as well (core/surfaces/microfacet.h)
    double roughness = 1;    // perceptual, 0..1
    Spectrum f0{};           // reflectance at normal incidence, in water
};

}  // namespace uw
