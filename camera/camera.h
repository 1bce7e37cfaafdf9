#pragma once

#include <optional>

#include "camera/lens/lens_model.h"
#include "camera/port/port.h"
#include "core/base/ray_source.h"

namespace uw {

/// A place in the image [pixels]; its corner is (0, 0), the first pixel's centre (0.5, 0.5).
struct ImagePoint {
    double x = 0;
    double y = 0;
};

/// A camera with Brown-Conrady or fisheye lens, in the water or behind a flat port or dome.
/// Camera frame: x right, y down, z forward; image corner (0, 0), first pixel centre (0.5, 0.5).
class Camera final : public RaySource {
  public:
    /// Precondition, checked by the scene reader: fx, fy > 0, a rigid pose, a unit port normal, the
    /// camera within its dome, and a calibration that has been read.
    explicit Camera(const CameraDesc& desc);

    int width() const override { return width_; }
    int height() const override { return height_; }
    /// See RaySource. Empty too where the lens shows nothing (beyond the fold of its distortion).
    std::optional<Ray> refracted_ray(double x, double y) const override;
    LensRay lens_ray(double x, double y) const override;
    bool port_dims() const override { return port_dims_; }
    const Affine& world_from_camera() const override { return world_from_camera_; }

    /// The unit direction that the lens shows at image position (x, y), camera frame, inside the
    /// housing; empty where the lens shows nothing.
    std::optional<Vector3> lens_direction(double x, double y) const;

    /// Where the camera sees a point of the world: the image position whose water ray meets it,
    /// to 1e-6 pixel, whether inside the image or not. Surfaces in between do not matter. Empty
    /// where no ray meets it: behind a pinhole, beyond what the lens shows, inside the housing or
    /// its glass. Through ports it solves one equation in one unknown, which has one root for any
    /// port whose glass and water are no less dense than its air.
    std::optional<ImagePoint> project(const Point3& world) const;

  private:
    int width_;
    int height_;
    IntrinsicsDesc intrinsics_;
    LensModel lens_;
    std::optional<Port> port_;
    bool port_dims_ = false;
    Affine world_from_camera_;
    Affine camera_from_world_;
};

}  // namespace uw
