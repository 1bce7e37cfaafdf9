#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "core/geometry/surfaces.h"

namespace uw::test {

/// Spheres and boxes in closed form, seen from outside and from inside, of any material.
class ClosedFormSurfaces : public Surfaces {
  public:
    struct Material {
        Spectrum reflectance{};
        SurfaceMaterial more{};  // emission and gloss
    };

    void add_sphere(const Point3& center, double radius, const Material& material) {
        parts_.push_back({true, center, Vector3(radius), material});
    }
    void add_box(const Point3& min, const Point3& max, const Material& material) {
        parts_.push_back({false, min + 0.5 * (max - min), 0.5 * (max - min), material});
    }

    double hit_distance(const Ray& ray) const override { return nearest(ray).distance; }

    bool closest_hit(const Ray& ray, double s_end, SurfaceHit& hit) const override {
        const Nearest found = nearest(ray);
        if (!(found.distance <= s_end)) return false;
        const Part& part = parts_[found.part];
        hit = {};
        hit.distance = found.distance;
        hit.position = ray.at(found.distance);
        hit.normal = normal(part, hit.position);
        if (glm::dot(hit.normal, ray.direction) > 0) hit.normal = -hit.normal;
        hit.geometric_normal = hit.normal;
        hit.reflectance = part.material.reflectance;
        hit.object_id = static_cast<std::uint32_t>(found.part + 1);
        hit.geometry = static_cast<std::uint32_t>(found.part);
        hit.has_material = true;
        return true;
    }
    SurfaceMaterial material(const SurfaceHit& hit) const override {
        return parts_[hit.geometry].material.more;
    }
    bool occluded(const Point3& from, const Point3& to) const override {
        const double length = distance(from, to);
        if (length == 0) return false;
        const Vector3 direction = (to - from) / length;
        const double skin = 1e-5 * length;
        return nearest({from + skin * direction, direction}).distance < length - 2 * skin;
    }
    Bounds bounds() const override {
        Bounds all;
        for (const Part& part : parts_)
            all.extend(Bounds{part.center - part.half, part.center + part.half});
        return all;
    }
    std::uint64_t triangle_count() const override { return 0; }
    bool empty() const override { return parts_.empty(); }

  private:
    struct Part {
        bool is_sphere;
        Point3 center;
        Vector3 half;  // extent from the center
        Material material;
    };
    struct Nearest {
        double distance = std::numeric_limits<double>::infinity();
        std::size_t part = 0;
    };

    // A ray from a point on a surface starts within rounding of it.
    static constexpr double k_skin = 1e-9;

    Nearest nearest(const Ray& ray) const {
        Nearest result;
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            const auto [enter, leave] =
                parts_[i].is_sphere ? cross_sphere(parts_[i], ray) : cross_box(parts_[i], ray);
            for (const double s : {enter, leave})
                if (s > k_skin && s < result.distance) result = {s, i};
        }
        return result;
    }
    static std::pair<double, double> cross_sphere(const Part& part, const Ray& ray) {
        const Vector3 o = ray.origin - part.center;
        const double b = glm::dot(o, ray.direction);
        const double root2 = b * b - glm::dot(o, o) + part.half.x * part.half.x;
        if (root2 < 0) return {-1, -1};
        return {-b - std::sqrt(root2), -b + std::sqrt(root2)};
    }
    static std::pair<double, double> cross_box(const Part& part, const Ray& ray) {
        double enter = -std::numeric_limits<double>::infinity(), leave = -enter;
        for (int axis = 0; axis < 3; ++axis) {
            const double o = ray.origin[axis] - part.center[axis], d = ray.direction[axis];
            const double middle = -o / d, reach = std::abs(part.half[axis] / d);
            if (d == 0) {
                if (std::abs(o) > part.half[axis]) return {-1, -1};
                continue;
            }
            enter = std::max(enter, middle - reach);
            leave = std::min(leave, middle + reach);
        }
        if (enter > leave) return {-1, -1};
        return {enter, leave};
    }
    /// Outwards.
    static Vector3 normal(const Part& part, const Point3& x) {
        const Vector3 v = (x - part.center) / part.half;
        if (part.is_sphere) return glm::normalize(v);
        const Vector3 size = glm::abs(v);
        const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
        Vector3 result(0);
        result[axis] = v[axis] > 0 ? 1 : -1;
        return result;
    }

    std::vector<Part> parts_;
};

}  // namespace uw::test
