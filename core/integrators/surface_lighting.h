#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/integrators/deep_shadow.h"
#include "core/integrators/lit_scene.h"
#include "core/integrators/surface_light.h"
#include "core/optics/optical_depth.h"

namespace uw {

/// Computes the light of every lamp incident on surfaces and its attenuation by the water (physics
/// section 5, `direct`). Thread safe.
class SurfaceLighting {
  public:
    virtual ~SurfaceLighting() = default;

    /// Light on each of `samples`; faster for batches of neighbouring samples.
    virtual void evaluate(std::span<const SurfaceSample* const> samples,
                          SurfaceLight& light) const = 0;
    /// Light on a single sample.
    void evaluate_one(const SurfaceSample& sample, SurfaceLight& light) const {
        const SurfaceSample* const one = &sample;
        evaluate(std::span(&one, 1), light);
    }
};

/// One exact shadow ray for each lamp that a surface faces. Columns are exact too, or interpolated
/// between neighbours (SurfaceColumns). The deep shadow maps' columns alone would not suffice: each
/// surface point depends on a single column, so its interpolation error would be visible.
class DirectLighting final : public SurfaceLighting {
  public:
    /// With exact columns.
    explicit DirectLighting(const LitScene& scene) : DirectLighting(scene, {}, 0) {}
    /// With columns interpolated to within `column_tolerance` (ColumnMixing). `deep_shadows`: one
    /// per emitter unless the tolerance is 0.
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
