#pragma once

#include <optional>

#include "core/base/ray.h"
#include "core/base/vector_math.h"
#include "core/scene/scene_context.h"

namespace uw {

/// The plane surface of calm water, as light meets it: Snell's law and Fresnel's reflectance
/// between two transparent media, for unpolarised light (Born and Wolf, section 1.5). World space.
///
/// Light from below comes back as if from behind a mirror. So the water has a mirror image above
/// the surface, with all that is in it, and what is reflected on its way between two points goes
/// straight from one to the other's image.
class WaterSurface {
  public:
    /// Precondition: `desc` has a refractive index.
    explicit WaterSurface(const WaterSurfaceDesc& desc)
        : point_(desc.point), up_(desc.normal), n_(desc.n.value()) {}

    /// Out of the water, unit.
    const Vector3& up() const { return up_; }
    double n() const { return n_; }
    /// The cosine, against the vertical, of the direction in the water beyond which all light is
    /// reflected.
    double critical_cosine() const;

    /// How far `x` lies above the surface [m]; negative in the water.
    double height(const Point3& x) const { return glm::dot(x - point_, up_); }
    Point3 mirrored(const Point3& x) const { return x - 2 * height(x) * up_; }
    Vector3 mirrored(const Vector3& v) const { return v - 2 * glm::dot(v, up_) * up_; }
    Ray mirrored(const Ray& ray) const { return {mirrored(ray.origin), mirrored(ray.direction)}; }
    /// Where the line from `a` to `b`, on different sides of it, passes the surface.
    Point3 between(const Point3& a, const Point3& b) const;
    /// The distance at which a ray from the water reaches the surface; none if it never does.
    std::optional<double> crossing(const Ray& ray) const;

    /// The share of the light that the surface reflects, 0..1, by the cosine of its direction
    /// against the vertical: of light from the water, and of light from the air.
    double reflectance_from_water(double cosine) const;
    double reflectance_from_air(double cosine) const;
    /// The direction into the air of light that travels along `direction` (unit, upwards) in the
    /// water; none if it is totally reflected. And the reverse, of light that travels downwards.
    std::optional<Vector3> into_air(const Vector3& direction) const;
    Vector3 into_water(const Vector3& direction) const;

  private:
    Point3 point_;
    Vector3 up_;
    double n_;
};

}  // namespace uw
