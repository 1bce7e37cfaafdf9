#pragma once

#include <array>
#include <optional>

#include "camera/lens/normalized_point.h"
#include "core/base/vec.h"
#include "core/scene/camera_desc.h"

namespace uw {

/// The equidistant fisheye lens of OpenCV and Kalibr (Kannala and Brandt 2006): a ray at the angle
/// theta to the optical axis is imaged at the radius
///   r = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)
/// from the principal point, in units of the focal length. Angles of 90 degrees and more need no
/// special treatment. Only the part around the axis, up to where r stops increasing or theta is 180
/// degrees, is meaningful; beyond that circle there is no ray.
class Fisheye {
  public:
    /// Precondition: `desc.model` is fisheye.
    explicit Fisheye(const DistortionDesc& desc);

    /// The unit direction, camera frame, that is imaged at `image`; empty outside the circle.
    std::optional<Vector3> direction(const NormalizedPoint& image) const;
    /// Where `direction` (unit, camera frame) is imaged; empty beyond the largest angle.
    std::optional<NormalizedPoint> image(const Vector3& direction) const;

    /// The irradiance behind the lens relative to that on the axis. A fisheye turns its entrance
    /// pupil towards the light and so lacks the cos^4 of a rectilinear lens; an area of the image
    /// receives what comes from the solid angle that it images, and d omega / d A = sin(theta) / (r
    /// dr/d theta).
    double falloff(const Vector3& direction) const;

    /// Angle to the axis up to which there are rays [rad], at most pi.
    double largest_angle() const { return largest_angle_; }

  private:
    double radius(double theta) const;
    double slope(double theta) const;  // dr/d theta
    double angle(double r) const;      // the inverse of radius; precondition: r <= largest_radius_

    std::array<double, 4> k_;
    double largest_angle_ = 0;
    double largest_radius_ = 0;
};

}  // namespace uw
