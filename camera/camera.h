#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "camera/lens_model.h"
#include "camera/port.h"
#include "core/base/ray.h"
#include "core/base/vector_math.h"
#include "core/scene/scene_desc.h"

namespace uw {

/// Changes the camera's resolution but not its view: the intrinsics [pixels] are scaled with it,
/// and the time from row to row, so that all rows take as long as before.
/// `width`, `height` >= 1.
inline void resize_image(CameraDesc& camera, int width, int height) {
    const double sx = static_cast<double>(width) / camera.width;
    const double sy = static_cast<double>(height) / camera.height;
    const IntrinsicsDesc& k = camera.intrinsics;
    camera.intrinsics = {k.fx * sx, k.fy * sy, k.cx * sx, k.cy * sy};
    camera.line_time /= sy;
    camera.width = width;
    camera.height = height;
}

/// Changes the resolution of every camera of a scene as resize_image does.
inline void resize_images(SceneDesc& scene, int width, int height) {
    resize_image(scene.camera, width, height);
    for (RigCameraDesc& entry : scene.cameras) resize_image(entry.camera, width, height);
}

/// A span of time, relative to that of a frame [s].
struct TimeSpan {
    double begin = 0, end = 0;

    double middle() const { return 0.5 * (begin + end); }
    double length() const { return end - begin; }
};

/// When the rows of an image are exposed. With a rolling shutter one row follows the other; the
/// middle of the image's height is exposed around the frame's time.
struct RowExposure {
    double shutter = 0;    ///< exposure time of a row [s]
    double line_time = 0;  ///< from row to row [s]
    int height = 0;        ///< rows
    /// The part of the exposure that counts. Rows that are not exposed within it are taken at its
    /// nearest end.
    TimeSpan part{-k_always, k_always};

    /// The middle of the whole exposure at image row `y` [pixels].
    double middle(double y) const { return (y - 0.5 * height) * line_time; }
    /// When image row `y` is exposed, within the part.
    TimeSpan at(double y) const {
        const double t = middle(y);
        return {std::clamp(t - 0.5 * shutter, part.begin, part.end),
                std::clamp(t + 0.5 * shutter, part.begin, part.end)};
    }
    /// When any row of the image is exposed, whatever the part.
    TimeSpan all() const { return {middle(0) - 0.5 * shutter, middle(height) + 0.5 * shutter}; }
    /// The fraction of the exposure of pixel row `row` that lies within the part.
    double fraction(int row) const {
        const double t = middle(row + 0.5);
        if (shutter > 0) return at(row + 0.5).length() / shutter;
        return t >= part.begin && t < part.end ? 1 : 0;
    }

  private:
    static constexpr double k_always = 1e30;
};

/// The motion of a camera around the time of its frame.
class CameraMotion {
  public:
    /// `world_from_camera`: poses at equal intervals over `span`, both ends included, two or more;
    /// between them positions and axes are interpolated linearly.
    CameraMotion(std::vector<Affine> world_from_camera, const TimeSpan& span)
        : poses_(std::move(world_from_camera)), span_(span) {}

    /// The pose at a time relative to the frame's; outside of the span, that of its nearest end.
    Affine at(double time) const;

  private:
    std::vector<Affine> poses_;
    TimeSpan span_;
};

/// A thin lens with its aperture at the camera's centre, focused at a plane across the optical axis
/// (docs/camera-image.md). In the housing's air all rays of an image position pass through one
/// point of a plane; through a port they meet where the water's refraction makes them.
class ThinLens {
  public:
    /// Precondition: the camera has a lens with a focus distance. Throws InputError if that lies
    /// before the water, and if the aperture does not fit into the dome.
    ThinLens(const CameraDesc& desc, const Port* port);

    /// The ray in the housing (camera frame) that leaves a point of the aperture, for the image
    /// position whose ray through the aperture's centre has `direction`, direction.z > 0.
    Ray ray(const Vector3& direction, const AperturePoint& point) const;

    /// 1 / distance of the plane in air where the rays of an image position meet [1/m]. Behind a
    /// port it is such that rays near the axis meet at the focus distance in the water.
    double vergence() const { return vergence_; }

  private:
    double radius_;  // of the aperture: focal length / (2 f-number) [m]
    double vergence_ = 0;
};

/// A position in the image [pixels]; the image corner is (0, 0), the first pixel's centre (0.5,
/// 0.5).
struct ImagePoint {
    double x = 0;
    double y = 0;
};

/// The image of a point in a camera.
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
    /// that of a part of the exposure, which represents all rows where one pose is needed.
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
    /// is consistent: the row is exposed at the moment at which the point is imaged there.
    std::optional<ImagePoint> project(const Point3& world) const;
    /// As project(), with the ray, which is cheaper than refracted_ray at that position.
    std::optional<Sighting> sight(const Point3& world) const;

  private:
    /// A point as the lens images it.
    struct Projection {
        ImagePoint image;
        Vector3 in_housing{0, 0, 1};  // the direction towards it, camera frame
    };
    // The ray in the water, world space, of one in the housing, for a pose of the camera.
    std::optional<Ray> in_water(const Ray& in_housing, const Affine& world_from_camera) const;
    std::optional<Projection> project_at_its_time(const Point3& world) const;
    std::optional<Projection> project_in_camera(const Point3& point) const;

    int width_;
    int height_;
    IntrinsicsDesc intrinsics_;
    LensModel lens_;
    std::shared_ptr<const Port> port_;  // null without a port
    bool port_dims_ = false;
    std::optional<ThinLens> thin_lens_;
    Affine world_from_camera_;
    Affine camera_from_world_;
    std::shared_ptr<const CameraMotion> motion_;  // null: it does not move
    RowExposure rows_;
};

}  // namespace uw
