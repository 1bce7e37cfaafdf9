#pragma once

#include "core/base/spectrum.h"

namespace uw {

/// What a surface does beside reflecting diffusely (SurfaceHit::reflectance).
struct SurfaceMaterial {
    Spectrum emission{};     // radiance of its own, the same in all directions [W m^-2 sr^-1]
    bool is_glossy = false;  // reflects as core/microfacet.h says, too
    double roughness = 1;    // perceptual, 0..1
    Spectrum f0{};           // reflectance on the normal, in water
};

}  // namespace uw
