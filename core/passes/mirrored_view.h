#pragma once

#include <optional>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/geometry/water_surface.h"
#include "core/light/integrator.h"

namespace uw {

/// The view of a camera by reflection in the water's surface: rays that meet the surface go on from
/// there in the reflected direction; all others are none. These rays form an image like any other,
/// whose light is then multiplied by the reflectance and by the transmittance of the path from the
/// surface to the camera (MirroredView::arriving).
class MirroredView final : public RaySource {
  public:
    /// References must outlive this object. Precondition: the scene has a water surface.
    MirroredView(const RaySource& rays, const LitScene& scene);

    /// Whether any of the camera's rays may meet the surface. A lattice of rays over the image is
    /// tested.
    static bool may_see(const RaySource& rays, const WaterSurface& surface);

    /// Returns the fraction of light, by band, that the surface reflects and that arrives at the
    /// camera, in pixel (x, y); 0 if none of its rays meets the surface.
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
    // Returns where the ray meets the surface; none if it hits something else first.
    std::optional<WaterSurface::Meeting> meeting(const Ray& ray) const;
    // Adds that fraction at image position (x, y); returns false if the surface is not visible
    // there.
    bool add_arriving(double x, double y, Spectrum& sum) const;
    std::optional<Ray> mirrored(const std::optional<Ray>& ray) const;

    const RaySource& rays_;
    LitScene scene_;
    AttenuationTable attenuation_;
};

}  // namespace uw
