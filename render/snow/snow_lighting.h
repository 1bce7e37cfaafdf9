#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/integrators/deep_shadow.h"
#include "core/integrators/lit_scene.h"
#include "core/optics/optical_depth.h"

namespace uw {

/// The light of particles as a camera sees it, lit by every emitter as the water around them is.
class SnowLighting {
  public:
    /// The light splatted may be empty: then columns are integrated. All arguments outlive this.
    SnowLighting(const LitScene& scene,
                 std::span<const std::shared_ptr<const DeepShadow>> deep_shadows)
        : scene_(scene), attenuation_(*scene.medium), deep_shadows_(deep_shadows) {}

    /// The mean radiance of the disk of a white particle at `x`, seen along `ray` at a `distance`
    /// [m], after the water on the way, into one value per band [W m^-2 sr^-1]. Thread safe.
    void radiance(const Point3& x, const Ray& ray, double distance,
                  std::span<double> radiance) const;

  private:
    LitScene scene_;
    AttenuationTable attenuation_;
    std::span<const std::shared_ptr<const DeepShadow>> deep_shadows_;
};

}  // namespace uw
