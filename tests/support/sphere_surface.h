#pragma once

#include <cmath>
#include <limits>

#include "core/geometry/surfaces.h"

namespace uw::test {

/// One sphere, in closed form: an occluder whose shadows are known exactly.
class SphereSurface : public Surfaces {
  public:
    SphereSurface(const Point3& center, double radius) : center_(center), radius_(radius) {}

    double hit_distance(const Ray& ray) const override {
        const Vector3 o = ray.origin - center_;
        const double b = glm::dot(o, ray.direction);
        const double root2 = b * b - glm::dot(o, o) + radius_ * radius_;
        if (root2 < 0) return std::numeric_limits<double>::infinity();
        for (const double s : {-b - std::sqrt(root2), -b + std::sqrt(root2)})
            if (s > 0) return s;
        return std::numeric_limits<double>::infinity();
    }
    bool closest_hit(const Ray& ray, double s_end, SurfaceHit& hit) const override {
        hit.distance = hit_distance(ray);
        hit.position = ray.at(hit.distance);
        hit.normal = hit.geometric_normal = (hit.position - center_) / radius_;
        hit.object_id = 1;
        return hit.distance <= s_end;
    }
    bool occluded(const Point3& from, const Point3& to) const override {
        const double length = distance(from, to);
        return hit_distance({from, (to - from) / length}) < length * (1 - 1e-5);
    }
    Bounds bounds() const override {
        return {center_ - Vector3(radius_), center_ + Vector3(radius_)};
    }
    std::uint64_t triangle_count() const override { return 0; }
    bool empty() const override { return false; }

  private:
    Point3 center_;
    double radius_;
};

}  // namespace uw::test
