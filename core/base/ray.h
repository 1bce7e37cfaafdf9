#pragma once

#include <optional>

#include "core/base/vector_math.h"

namespace uw {

/// A half-line; `direction` is unit, so that the parameter of `at` is in metres.
struct Ray {
    Point3 origin;
    Vector3 direction{0, 0, 1};

    Point3 at(double s) const { return origin + s * direction; }
};

/// An interval [begin, end] along a ray, in metres from its origin.
struct Interval {
    double begin = 0;
    double end = 0;

    double length() const { return end - begin; }
};

/// An axis-aligned bounding box in the space that its owner specifies; empty while min > max.
struct Bounds {
    Point3 min{1e300, 1e300, 1e300};
    Point3 max{-1e300, -1e300, -1e300};

    bool empty() const { return min.x > max.x || min.y > max.y || min.z > max.z; }
    void extend(const Point3& p) {
        for (int axis = 0; axis < 3; ++axis) {
            min[axis] = glm::min(min[axis], p[axis]);
            max[axis] = glm::max(max[axis], p[axis]);
        }
    }
    void extend(const Bounds& b) {
        if (!b.empty()) {
            extend(b.min);
            extend(b.max);
        }
    }
    Point3 center() const { return min + 0.5 * (max - min); }
    double diagonal() const { return empty() ? 0.0 : glm::length(max - min); }
};

/// How light arrives at the lens.
struct LensRay {
    /// The irradiance behind the lens relative to that on its axis, for equal radiance: cos^4 of
    /// the angle to the optical axis, inside the housing, for a rectilinear lens.
    double falloff = 1;
    /// The port's factor on the radiance in water; 1 unless the scene requests it.
    double port_transmittance = 1;
};

/// A point of a lens's aperture, in units of its radius from its centre: right and down.
struct AperturePoint {
    double u = 0;
    double v = 0;
};

/// Generates camera rays: from a pixel to its ray in the water. Thread safe.
class RaySource {
  public:
    virtual ~RaySource() = default;

    virtual int width() const = 0;
    virtual int height() const = 0;

    /// The ray in water (world space) that the camera sees at image position (x, y) in pixels; the
    /// image's corner is (0, 0), the first pixel's centre (0.5, 0.5). Its origin lies on the outer
    /// glass surface, or at the camera centre without a port. Empty if no ray enters the water: it
    /// misses the port or is totally reflected.
    virtual std::optional<Ray> refracted_ray(double x, double y) const = 0;

    /// How the light of the water ray at image position (x, y) arrives at the lens.
    /// Precondition: there is a water ray.
    virtual LensRay lens_ray(double x, double y) const = 0;
    /// Whether some lens ray's port_transmittance is not 1.
    virtual bool port_dims() const = 0;

    /// Whether the lens has a focus, so that rays through different points of its aperture differ.
    virtual bool has_aperture() const { return false; }
    /// Whether the camera moves while a pixel is exposed, so that rays at different moments differ.
    virtual bool moves() const { return false; }
    /// The ray in water of image position (x, y) through a point of the aperture, at a moment of
    /// the pixel's exposure (0 its begin, 1 its end); through the centre, in the middle, it is
    /// refracted_ray.
    virtual std::optional<Ray> aperture_ray(double x, double y, const AperturePoint& /*point*/,
                                            double /*moment*/ = 0.5) const {
        return refracted_ray(x, y);
    }
    /// 1 / distance of the plane in focus, as the lens sees it in the housing's air [1/m].
    virtual double focus_vergence() const { return 0; }

    virtual const Affine& world_from_camera() const = 0;
    /// Whether the pose differs from row to row: a rolling shutter.
    virtual bool is_rolling() const { return false; }
    /// The pose that refracted_ray has at image row `y`.
    virtual Affine world_from_camera_at(double /*y*/) const { return world_from_camera(); }
};

}  // namespace uw
