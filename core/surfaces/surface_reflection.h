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
