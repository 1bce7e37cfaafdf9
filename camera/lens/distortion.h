#pragma once

#include <optional>

#include "camera/lens/normalized_point.h"
#include "core/base/vec.h"
#include "core/scene/camera_desc.h"

namespace uw {

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

}  // namespace uw
