#pragma once

#include <optional>

#include "camera/distortion.h"
#include "camera/flat_port.h"
#include "core/water_ray.h"

namespace uw {

/// A perspective camera with Brown-Conrady distortion, in the water or behind a flat port.
/// Camera frame: x right, y down, z forward; image corner (0, 0), first pixel centre (0.5, 0.5).
class Camera final : public RaySource {
  public:
    /// Precondition, checked by the scene reader: fx, fy > 0, a rigid pose, a unit port normal.
    explicit Camera(const CameraDesc& desc);

    int width() const override { return width_; }
    int height() const override { return height_; }
    /// See RaySource. Empty too where the distortion shows nothing (beyond its fold).
    std::optional<Ray> water_ray(double x, double y) const override;
    LensRay lens_ray(double x, double y) const override;
    const Affine& world_from_camera() const override { return world_from_camera_; }

  private:
    // In camera space, inside the housing, unit; empty where the distortion shows nothing.
    std::optional<Vector3> direction(double x, double y) const;

    int width_;
    int height_;
    IntrinsicsDesc intrinsics_;
    Distortion distortion_;
    std::optional<FlatPort> port_;
    Affine world_from_camera_;
};

}  // namespace uw
