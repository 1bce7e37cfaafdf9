#pragma once

#include <limits>
#include <optional>
#include <string>

#include "core/base/ray.h"
#include "core/scene/scene_desc.h"

namespace uw {

/// Denotes the distance of a pixel that sees no surface [m].
inline constexpr double k_infinitely_far = std::numeric_limits<double>::infinity();

/// ((R - F)/R)^2: the light that reaches the sensor behind a lens of focal length F [m] focused at
/// distance R [m], relative to focus at infinity. It is 0 for R <= F, where no real image is
/// formed.
double focus_factor(double distance, double focal_length);

/// The quantity that an image holds (docs/physics.md, section 7), as factors on the radiance in
/// water:
///   radiance           1: W m^-2 sr^-1
///   sensor_irradiance  pi / (4 N^2) T_l cos^4(theta) ((R - F)/R)^2, R the range of the surface at
///                      the pixel's centre for all of the pixel's light: W m^-2
///   paper              pi / (4 N)   T_l cos^4(theta) ((R - F)/R)^2, as printed in equations (15)
///                      and (18) of Sedlazeck and Koch 2011: R is the path in water from each
///                      surface point, and from each bit of water that scatters
/// In all three, the port's transmittance is applied in addition.
class SensorModel {
  public:
    /// The radiance itself.
    SensorModel() = default;
    /// Precondition, checked by the scene reader: every output but radiance has a lens.
    explicit SensorModel(const SceneDesc& desc);
    /// The same for any output of a camera.
    SensorModel(RenderDesc::Output output, const std::optional<LensDesc>& lens);

    /// Whether the factors depend on LensRay::falloff and the range.
    bool uses_lens() const { return output_ != RenderDesc::Output::radiance; }

    /// The factor on all light of a pixel. `range`: that of the surface at the pixel's centre [m],
    /// k_infinitely_far if there is none.
    double pixel_factor(const LensRay& lens_ray, double range) const;
    /// The additional factor on light from a surface after `path` metres in water.
    /// FocusWeightedIntegrator applies the same factor to in-scatter, by its own distance.
    double surface_factor(double path) const;
    /// Mean of surface_factor over the paths from `begin` to `end` [m], begin < end.
    double mean_surface_factor(double begin, double end) const;

    /// Whether light scattered forward on its way to the camera gets the factors of the pixel it
    /// comes from, as in equations (16) and (18) of the paper, which blur the irradiance of pixels.
    /// Otherwise it gets those of the pixel where it lands.
    bool factors_before_blur() const { return output_ == RenderDesc::Output::paper; }

    /// The quantity and its unit, for image headers: "radiance W m^-2 sr^-1".
    std::string description() const;

  private:
    RenderDesc::Output output_ = RenderDesc::Output::radiance;
    LensDesc lens_;
};

}  // namespace uw
