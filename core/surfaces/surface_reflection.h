#pragma once

#include <optional>

#include "core/surfaces/surface_material.h"
#include "core/surfaces/surface_sample.h"

namespace uw {

/// The light from a surface towards the camera: its BRDF and its emission.
class SurfaceReflection {
  public:
    /// Refers to `sample`.
    SurfaceReflection(const Surfaces& surfaces, const SurfaceSample& sample, int band_count);

    /// BRDF per band [1/sr] for light from a lamp at `position`: rho/pi for a diffuse surface; (1 -
    /// F) rho/pi + F D V for a glossy one (glTF 2.0, appendix B).
    void brdf(const Point3& position, Spectrum& values) const;
    /// The same for light from the unit direction `to_light`.
    void brdf_towards(const Vector3& to_light, Spectrum& values) const;

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
