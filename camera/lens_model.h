#pragma once

#include <array>
#include <optional>
#include <span>
#include <variant>

#include "core/base/vector_math.h"
#include "core/scene/camera_desc.h"

namespace uw {

/// The smallest x in (0, limit] where the polynomial sum_i coefficients[i] x^i changes sign; empty
/// if there is none. Safe for any degree up to 16 and any finite coefficients: roots are bracketed
/// by those of the derivative and bisected, so none is stepped over. (Declared for its tests: no
/// lens has roots as close or numbers as large.)
std::optional<double> first_positive_root(std::span<const double> coefficients, double limit);

/// A position in the image in units of the focal length, relative to the principal point: where a
/// pinhole images the direction (x, y, 1).
struct NormalizedPoint {
    double x = 0;
    double y = 0;
};

/// Brown-Conrady lens distortion, rational form, as in OpenCV (k1 k2 p1 p2 k3 k4 k5 k6):
///   f(r) = (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
///   x'   = f x + 2 p1 x y + p2 (r^2 + 2 x^2),   y' = f y + p1 (r^2 + 2 y^2) + 2 p2 x y.
/// The polynomial turns back on itself at some radius for most real lenses. Only the part around
/// the axis, up to that fold, is meaningful; beyond it there is no ray.
class Distortion {
  public:
    explicit Distortion(const DistortionDesc& desc);

    /// The distorted position of an undistorted point. For points beyond the fold it is what the
    /// formula gives, although no camera images them.
    NormalizedPoint distort(const NormalizedPoint& undistorted) const;

    /// The inverse of `distort` on the part around the axis, to 1e-10; empty where no point of that
    /// part is imaged at `distorted`.
    std::optional<NormalizedPoint> undistort(const NormalizedPoint& distorted) const;

    /// The unit direction, camera frame, that is imaged at `image`; empty as for `undistort`.
    std::optional<Vector3> direction(const NormalizedPoint& image) const;
    /// Where `direction` (unit, camera frame) is imaged; empty if it points backwards or lies
    /// beyond the fold: exactly where no image point has this `direction`.
    std::optional<NormalizedPoint> image(const Vector3& direction) const;
    /// The irradiance behind the lens relative to that on the axis: the cos^4 of a rectilinear
    /// lens, whose distortion is assumed small.
    static double falloff(const Vector3& direction);

    /// Undistorted radius up to which the radial model increases; infinite if it always does.
    double fold_radius() const { return fold_radius_; }

  private:
    struct Jacobian {  // symmetric: the model is the gradient of a potential
        double xx, xy, yy;
    };
    /// f and df/d(r^2).
    struct Radial {
        double factor, slope;
    };
    Radial radial(double r2) const;
    Jacobian jacobian(const NormalizedPoint& p) const;
    bool in_domain(const NormalizedPoint& p, const Jacobian& j) const;

    DistortionDesc desc_;
    bool identity_ = true;
    double fold_radius_ = 0;
};

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
    double max_angle() const { return max_angle_; }

  private:
    double radius(double theta) const;
    double slope(double theta) const;  // dr/d theta
    double angle(double r) const;      // the inverse of radius; precondition: r <= max_radius_

    std::array<double, 4> k_;
    double max_angle_ = 0;
    double max_radius_ = 0;
};

/// How a lens maps directions to the image. All have `direction`, `image` and `falloff`.
using LensModel = std::variant<Distortion, Fisheye>;

inline LensModel make_lens_model(const DistortionDesc& desc) {
    if (desc.model == DistortionDesc::Model::fisheye) return Fisheye(desc);
    return Distortion(desc);
}

}  // namespace uw
