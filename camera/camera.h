#pragma once

#include <memory>
#include <optional>

#include "camera/camera_motion.h"
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

/// How a camera sees a point.
struct Sighting {
    ImagePoint image;
    Ray ray;  // in water, world space: the one that passes through the point
};

/// A camera with Brown-Conrady or fisheye lens, in the water or behind a flat port or dome.
/// Camera frame: x right, y down, z forward; image corner (0, 0), first pixel centre (0.5, 0.5).
class Camera final : public RaySource {
  public:
    /// Precondition, checked by the scene reader: fx, fy > 0, a rigid pose, a unit port normal, the
    /// camera within its dome, and a calibration that has been read. Throws as ThinLens.
    explicit Camera(const CameraDesc& desc);
    /// A camera that moves while its rows are exposed. `desc` has its pose at the frame's time, or
    /// of a part of the exposure, which stands for all of its rows where one pose must do.
    Camera(const CameraDesc& desc, std::shared_ptr<const CameraMotion> motion,
           const RowExposure& rows);

    int width() const override { return width_; }
    int height() const override { return height_; }
    /// See RaySource. Also empty where the lens has no ray (beyond the fold of its distortion).
    std::optional<Ray> refracted_ray(double x, double y) const override;
    LensRay lens_ray(double x, double y) const override;
    bool port_dims() const override { return port_dims_; }
    bool has_aperture() const override { return thin_lens_.has_value(); }
    bool moves() const override { return motion_ != nullptr && rows_.shutter > 0; }
    std::optional<Ray> aperture_ray(double x, double y, const AperturePoint& point,
                                    double moment = 0.5) const override;
    double focus_vergence() const override { return thin_lens_ ? thin_lens_->vergence() : 0; }
    const Affine& world_from_camera() const override { return world_from_camera_; }
    bool is_rolling() const override { return motion_ != nullptr && rows_.line_time > 0; }
    Affine world_from_camera_at(double y) const override {
        return motion_ ? motion_->at(rows_.at(y).middle()) : world_from_camera_;
    }

    /// The unit direction, in the camera frame inside the housing, that the lens images at (x, y);
    /// empty where the lens has no ray.
    std::optional<Vector3> lens_direction(double x, double y) const;

    /// The image position of a point of the world: the one whose water ray passes through it, to
    /// 1e-6 pixel, whether inside the image or not. Occluding surfaces are ignored. Empty where
    /// there is no such ray: behind a pinhole, outside the field of the lens, inside the housing or
    /// its glass. Behind a port this solves one equation in one unknown, which has a single root if
    /// glass and water are at least as dense optically as the port's air. With a rolling shutter it
    /// is where the row shows it that is exposed when it is there.
    std::optional<ImagePoint> project(const Point3& world) const;
    /// The same with the ray, which costs less than refracted_ray at that position.
    std::optional<Sighting> sight(const Point3& world) const;

  private:
    /// A point as the lens images it.
    struct Projection {
        ImagePoint image;
        Vector3 in_housing{0, 0, 1};  // where it comes from, camera frame
    };
    // The ray in the water, world space, of one in the housing, seen from a pose.
    std::optional<Ray> in_water(const Ray& in_housing, const Affine& world_from_camera) const;
    std::optional<Projection> project_at_its_time(const Point3& world) const;
    std::optional<Projection> project_in_camera(const Point3& point) const;

    int width_;
    int height_;
    IntrinsicsDesc intrinsics_;
    LensModel lens_;
    std::optional<Port> port_;
    bool port_dims_ = false;
    std::optional<ThinLens> thin_lens_;
    Affine world_from_camera_;
    Affine camera_from_world_;
    std::shared_ptr<const CameraMotion> motion_;  // null: it stands still
    RowExposure rows_;
};

}  // namespace uw
