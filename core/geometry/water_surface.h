#pragma once

#include <memory>
#include <optional>

#include "core/base/ray.h"
#include "core/base/vector_math.h"
#include "core/scene/scene_context.h"

namespace uw {

class WaterWaves;

/// The same surface, calm.
inline WaterSurfaceDesc without_waves(WaterSurfaceDesc desc) {
    desc.waves.reset();
    return desc;
}

/// The optical interface between water and air: Snell's law and Fresnel's reflectance between two
/// transparent media, for unpolarised light (Born and Wolf, section 1.5). World space.
///
/// Calm water reflects light from below like a mirror. The water and everything in it therefore has
/// a mirror image above the surface, and a reflected path between two points is a straight line
/// from one to the image of the other.
class WaterSurface {
  public:
    /// `time` [s]: the moment at which waves are evaluated. Precondition: `desc` has a refractive
    /// index. Throws as WaterWaves.
    explicit WaterSurface(const WaterSurfaceDesc& desc, double time = 0);

    /// The normal of calm water, out of it, unit.
    const Vector3& up() const { return up_; }
    double n() const { return n_; }
    bool has_waves() const { return waves_ != nullptr; }
    const WaterWaves* waves() const { return waves_.get(); }
    /// The coordinates of a point and of a vector in the surface's own axes, which are those of
    /// waves: across, along, and up from calm water [m].
    Vector3 coordinates(const Point3& x) const { return in_plane(x - point_); }
    Vector3 in_plane(const Vector3& v) const {
        return {glm::dot(v, across_), glm::dot(v, along_), glm::dot(v, up_)};
    }
    /// All of the surface lies above this height [m, <= 0].
    double lowest() const;
    /// The cosine, against the normal, of the direction in the water beyond which all light is
    /// reflected.
    double critical_cosine() const;

    /// How far `x` lies above calm water [m]; negative in the water.
    double height(const Point3& x) const { return glm::dot(x - point_, up_); }
    /// Mirror images at calm water.
    Point3 mirrored(const Point3& x) const { return x - 2 * height(x) * up_; }
    Vector3 mirrored(const Vector3& v) const { return v - 2 * glm::dot(v, up_) * up_; }
    Ray mirrored(const Ray& ray) const { return {mirrored(ray.origin), mirrored(ray.direction)}; }
    /// The point at which the line from `a` to `b`, on different sides, crosses calm water.
    Point3 between(const Point3& a, const Point3& b) const;
    /// The distance at which a ray from the water crosses calm water; none if it never does.
    std::optional<double> crossing(const Ray& ray) const;

    /// Where a ray from the water meets the surface, waves included.
    struct Meeting {
        double distance = 0;  // along the ray [m]
        Vector3 normal;       // out of the water, unit
    };
    std::optional<Meeting> meet(const Ray& ray, double s_end) const;
    /// The ray that is reflected there: a little below the surface, so as not to meet it again.
    Ray reflected(const Ray& ray, const Meeting& meeting) const;

    /// Fresnel's reflectance of the surface, 0..1, by the cosine of the light's direction against
    /// the normal: for light from the water, and for light from the air.
    double reflectance_from_water(double cosine) const;
    double reflectance_from_air(double cosine) const;
    /// The direction into the air of light that travels along `direction` (unit, upwards) in the
    /// water and meets the surface where it has this normal; none if it is totally reflected.
    std::optional<Vector3> into_air(const Vector3& direction, const Vector3& normal) const;
    /// The direction in the water of light that travels downwards and meets calm water.
    Vector3 into_water(const Vector3& direction) const;
    /// The same where the surface has this normal; both in the same axes, of any space.
    std::optional<Vector3> refracted_into_water(const Vector3& direction,
                                                const Vector3& normal) const;
    /// Unit vectors in calm water, perpendicular to each other.
    const Vector3& across() const { return across_; }
    const Vector3& along() const { return along_; }

    friend bool operator==(const WaterSurface&, const WaterSurface&) = default;

  private:
    Point3 point_;
    Vector3 up_, across_, along_;
    double n_;
    std::shared_ptr<const WaterWaves> waves_;  // null: calm
};

}  // namespace uw
