#pragma once

#include "core/base/vec.h"

namespace uw {

/// Refractive index of the water around surfaces: the dielectric's reflectance is relative to it.
inline constexpr double k_surface_water_index = 1.334;

/// Smaller roughnesses count as this: on a smoother surface the highlight of a point lamp is
/// narrower than 0.3 degrees, too small for the samples of pixels to meet it evenly.
inline constexpr double k_smallest_roughness = 0.05;

/// Reflectance at normal incidence of a dielectric of refractive index `ior` under water,
/// ((n - n_w)/(n + n_w))^2; an `ior` of 0 reflects everything (KHR_materials_ior).
double dielectric_f0(double ior);

/// Reflection by the microfacets of a rough surface under a single lamp: GGX normals, Smith's
/// height-correlated masking (glTF 2.0, appendix B; Heitz 2014). Directions are unit, from the
/// surface.
struct MicrofacetLobe {
    double density = 0;         // D V: the specular BRDF without Fresnel's factor [1/sr]
    double fresnel_weight = 0;  // (1 - v.h)^5: F = f0 + (1 - f0) weight (Schlick 1994)

    double fresnel(double f0) const { return f0 + (1 - f0) * fresnel_weight; }
};
MicrofacetLobe microfacet_lobe(const Vector3& normal, const Vector3& to_camera,
                               const Vector3& to_lamp, double roughness);

}  // namespace uw
