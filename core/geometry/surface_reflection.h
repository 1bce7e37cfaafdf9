#pragma once

#include <optional>

#include "core/base/vector_math.h"
#include "core/geometry/surfaces.h"

namespace uw {

/// Refractive index of the water around surfaces, which the reflectance of dielectrics is relative
/// to.
inline constexpr double k_surface_water_index = 1.334;

/// Lower bound to which roughness is clamped: on a smoother surface the highlight of a point lamp
/// is narrower than 0.3 degrees, too small for the pixels' samples to resolve it reliably.
inline constexpr double k_min_roughness = 0.05;

/// Reflectance at normal incidence of a dielectric of refractive index `ior` under water,
/// ((n - n_w)/(n + n_w))^2; an `ior` of 0 reflects everything (KHR_materials_ior).
double dielectric_f0(double ior);

/// Microfacet reflection of a rough surface under a single lamp: GGX normal distribution, Smith's
/// height-correlated masking (glTF 2.0, appendix B; Heitz 2014). Directions are unit and point away
/// from the surface.
struct MicrofacetLobe {
    double density = 0;         // D V: the specular BRDF without the Fresnel factor [1/sr]
    double fresnel_weight = 0;  // (1 - v.h)^5: F = f0 + (1 - f0) weight (Schlick 1994)

    double fresnel(double f0) const { return f0 + (1 - f0) * fresnel_weight; }
};
/// Evaluates the lobe. A lamp of small angular radius `lamp_angle` [radians] is treated as a point,
/// with the roughness increased so that the highlights of such lamps side by side join to a single
/// smooth one.
MicrofacetLobe microfacet_lobe(const Vector3& normal, const Vector3& to_camera,
                               const Vector3& to_lamp, double roughness, double lamp_angle = 0);

/// Samples tan(theta / 2) of the angle theta between the normal and a half vector with the pdf
/// D (n.h) over directions; `u` is uniform in [0, 1) (Walter et al. 2007, equation 35).
double sample_half_vector(double u, double roughness);
/// The pdf over directions [1/sr] of `to_light` as the reflection of `to_camera` at such a half
/// vector: D (n.h) / (4 v.h).
double half_vector_density(const Vector3& normal, const Vector3& to_camera, const Vector3& to_light,
                           double roughness);

/// The light from a surface towards the camera: its BRDF and its emission.
class SurfaceReflection {
  public:
    /// Refers to `sample`.
    SurfaceReflection(const Surfaces& surfaces, const SurfaceSample& sample, int band_count);

    /// BRDF per band [1/sr] for light from a lamp at `position`: rho/pi for a diffuse surface; (1 -
    /// F) rho/pi + F D V for a glossy one (glTF 2.0, appendix B).
    void brdf(const Point3& position, Spectrum& values) const;
    /// The same for light from the unit direction `to_light`; `lamp_angle` as in microfacet_lobe.
    void brdf_towards(const Vector3& to_light, Spectrum& values, double lamp_angle = 0) const;

    /// Whether it has a specular lobe, and its roughness, 0..1. Precondition of the second: the
    /// first.
    bool is_glossy() const { return material_ && material_->is_glossy; }
    double roughness() const { return material_->roughness; }

    /// Whether the surface emits light of its own.
    bool emits() const { return emits_; }
    /// Precondition: emits().
    const Spectrum& emission() const { return material_->emission; }

  private:
    const SurfaceSample* sample_;
    std::size_t bands_;
    std::optional<SurfaceMaterial> material_;  // empty: diffuse, no emission
    bool emits_ = false;
};

}  // namespace uw
