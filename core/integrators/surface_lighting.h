#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/integrators/deep_shadow.h"
#include "core/integrators/lit_scene.h"
#include "core/integrators/surface_light.h"
#include "core/optics/optical_depth.h"

namespace uw {

/// Finds the light of every lamp that falls on surfaces, and what the water leaves of it (physics
/// section 5, `direct`). Thread safe.
class SurfaceLighting {
  public:
    virtual ~SurfaceLighting() = default;

    /// Light on each of `samples`; faster for many at once that are seen side by side.
    virtual void evaluate(std::span<const SurfaceSample* const> samples,
                          SurfaceLight& light) const = 0;
    /// Light on one.
    void evaluate_one(const SurfaceSample& sample, SurfaceLight& light) const {
        const SurfaceSample* const one = &sample;
        evaluate(std::span(&one, 1), light);
    }
};

/// One exact shadow ray for each lamp that a surface faces. Columns are exact too, or interpolated
/// between those of neighbours (SurfaceColumns). The columns of the deep shadow maps alone would
/// not do: each point of a surface shows a single column, and so the error of its interpolation.
class DirectLighting final : public SurfaceLighting {
  public:
    /// With exact columns.
    explicit DirectLighting(const LitScene& scene) : DirectLighting(scene, {}, 0) {}
    /// With columns interpolated to `column_tolerance` (ColumnMixing). `deep_shadows`: one per lamp
    /// unless the tolerance is 0.
    DirectLighting(const LitScene& scene,
                   std::vector<std::shared_ptr<const DeepShadow>> deep_shadows,
                   double column_tolerance);

    void evaluate(std::span<const SurfaceSample* const> samples,
                  SurfaceLight& light) const override;

  private:
    LitScene scene_;
    AttenuationTable attenuation_;
    std::vector<std::shared_ptr<const DeepShadow>> deep_shadows_;
    double column_tolerance_;
};

}  // namespace uw
