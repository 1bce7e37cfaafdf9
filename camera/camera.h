#pragma once

#include <optional>

#include "camera/lens/lens_model.h"
#include "camera/port/port.h"
#include "camera/thin_lens.h"
#include "core/base/ray_source.h"

namespace uw {

/// A position in the image [pixels]; the image corner is (0, 0), the first pixel's centre (0.5,
/// 0.5).
struct ImagePoint {
    double x = 0;
    double y = 0;
};

/// A camera with Brown-Conrady or fisheye lens, in the water or behind a flat port or dome.
/// Camera frame: x right, y down, z forward; image corner (0, 0), first pixel centre (0.5, 0.5).
class Camera final : public RaySource {
  public:
    /// Precondition, checked by the scene reader: fx, fy > 0, a rigid pose, a unit port normal, the
    /// camera within its dome, and a calibration that has been read. Throws as ThinLens.
    explicit Camera(const CameraDesc& desc);

    int width() const override { return width_; }
    int height() const override { return height_; }
    /// See RaySource. Also empty where the lens has no ray (beyond the fold of its distortion).
    std::optional<Ray> refracted_ray(double x, double y) const override;
    LensRay lens_ray(double x, double y) const override;
    bool port_dims() const override { return port_dims_; }
    bool has_aperture() const override { return thin_lens_.has_value(); }
    std::optional<Ray> aperture_ray(double x, double y, const AperturePoint& point) const override;
    double focus_vergence() const override { return thin_lens_ ? thin_lens_->vergence() : 0; }
    const Affine& world_from_camera() const override { return world_from_camera_; }

    /// The unit direction, in the camera frame inside the housing, that the lens images at (x, y);
    /// empty where the lens has no ray.
    std::optional<Vector3> lens_direction(double x, double y) const;

    /// The image position of a point of the world: the one whose water ray passes through it, to
    /// 1e-6 pixel, whether inside the image or not. Occluding surfaces are ignored. Empty where
    /// there is no such ray: behind a pinhole, outside the field of the lens, inside the housing or
    /// its glass. Behind a port this solves one equation in one unknown, which has a single root if
    /// glass and water are at least as dense optically as the port's air.
    std::optional<ImagePoint> project(const Point3& world) const;

  private:
    // The ray in the world of one in the housing, camera frame.
    std::optional<Ray> in_water(const Ray& in_housing) const;

    int width_;
    int height_;
    IntrinsicsDesc intrinsics_;
    LensModel lens_;
    std::optional<Port> port_;
    bool port_dims_ = false;
    std::optional<ThinLens> thin_lens_;
    Affine world_from_camera_;
    Affine camera_from_world_;
};

}  // namespace uw
