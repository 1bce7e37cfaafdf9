#pragma once

#include <optional>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/geometry/water_surface.h"
#include "core/light/integrator.h"

namespace uw {

/// What a camera sees in the water's surface: the rays of those of its rays that meet the surface,
/// from there on. The rest have none. The image that they make is an image like any other, dimmed
/// by the way that the light has come from the surface (MirroredView::arriving).
class MirroredView final : public RaySource {
  public:
    /// References must outlive this object. Precondition: the scene has a water surface.
    MirroredView(const RaySource& rays, const LitScene& scene);

    /// Whether any of the camera's rays may meet the surface: those of a lattice over its image
    /// tell whether one rises.
    static bool may_see(const RaySource& rays, const WaterSurface& surface);

    /// The share of light, by band, that is reflected and arrives at the camera, in pixel (x, y);
    /// 0 if none of its rays meets the surface.
    Spectrum arriving(int x, int y) const;

    int width() const override { return rays_.width(); }
    int height() const override { return rays_.height(); }
    std::optional<Ray> refracted_ray(double x, double y) const override {
        return mirrored(rays_.refracted_ray(x, y));
    }
    LensRay lens_ray(double x, double y) const override { return rays_.lens_ray(x, y); }
    bool port_dims() const override { return rays_.port_dims(); }
    bool has_aperture() const override { return rays_.has_aperture(); }
    bool moves() const override { return rays_.moves(); }
    std::optional<Ray> aperture_ray(double x, double y, const AperturePoint& point,
                                    double moment) const override {
        return mirrored(rays_.aperture_ray(x, y, point, moment));
    }
    double focus_vergence() const override { return rays_.focus_vergence(); }
    const Affine& world_from_camera() const override { return rays_.world_from_camera(); }
    bool is_rolling() const override { return rays_.is_rolling(); }
    Affine world_from_camera_at(double y) const override { return rays_.world_from_camera_at(y); }

  private:
    // None if something else is nearer.
    std::optional<WaterSurface::Meeting> meeting(const Ray& ray) const;
    // Adds the share at image position (x, y); false if the surface is not seen there.
    bool add_arriving(double x, double y, Spectrum& sum) const;
    std::optional<Ray> mirrored(const std::optional<Ray>& ray) const;

    const RaySource& rays_;
    LitScene scene_;
    AttenuationTable attenuation_;
};

}  // namespace uw
