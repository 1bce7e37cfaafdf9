#include "core/light/profile_geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uw {

DirectionCone DirectionCone::widened(double angle) const {
    const double wide = std::acos(std::max(-1.0, cosine)) + angle;
    return {axis, wide < std::numbers::pi ? std::cos(wide) : -1.0};
}

bool DirectionCone::includes(const DirectionCone& other) const {
    if (has_all() || other.has_all()) return has_all();
    return angle_between(axis, other.axis) + std::acos(other.cosine) <= std::acos(cosine) + 1e-12;
}

namespace {

// Where on the line of `ray` the angle to `axis` has its extremum; may be infinite or NaN.
double extremal_angle(const Ray& ray, const Point3& apex, const Vector3& axis) {
    const Vector3 o = ray.origin - apex;
    const double da = glm::dot(ray.direction, axis), oa = glm::dot(o, axis);
    const double od = glm::dot(o, ray.direction);
    // d/ds (x.a / |x|) = 0 with x = o + s d: linear in s.
    return (da * glm::dot(o, o) - oa * od) / (oa - da * od);
}

}  // namespace

void append_cone_crossings(const Ray& ray, const Point3& apex, const Vector3& axis,
                           double cos_angle, std::vector<double>& s) {
    const Vector3 o = ray.origin - apex;
    const double da = glm::dot(ray.direction, axis);
    const double oa = glm::dot(o, axis);
    const double cos2 = cos_angle * cos_angle;
    // (x.a)^2 = cos^2 |x|^2 with x = o + s d: a quadratic in s.
    const double a = da * da - cos2;
    const double half_b = da * oa - cos2 * glm::dot(o, ray.direction);
    const double c = oa * oa - cos2 * glm::dot(o, o);
    const auto append = [&](double root) {
        // The quadratic describes both halves of the double cone; keep the lamp's own.
        const double along_axis = oa + root * da;
        if (std::isfinite(root) && root > 0 && along_axis * cos_angle >= 0) s.push_back(root);
    };
    const double discriminant = half_b * half_b - a * c;
    if (discriminant < 0) return;
    const double q = -(half_b + std::copysign(std::sqrt(discriminant), half_b));
    if (a != 0) append(q / a);
    if (q != 0) append(c / q);
}

void append_plane_crossing(const Ray& ray, const Point3& apex, const Vector3& normal,
                           std::vector<double>& s) {
    const double root = -glm::dot(ray.origin - apex, normal) / glm::dot(ray.direction, normal);
    if (std::isfinite(root) && root > 0) s.push_back(root);
}

void append_half_plane_crossing(const Ray& ray, const Point3& apex, const Vector3& side,
                                const Vector3& normal, std::vector<double>& s) {
    const double root = -glm::dot(ray.origin - apex, normal) / glm::dot(ray.direction, normal);
    if (std::isfinite(root) && root > 0 && glm::dot(ray.at(root) - apex, side) >= 0)
        s.push_back(root);
}

AxisApproach approach_to_axis(const Ray& ray, const Interval& interval, const Point3& apex,
                              const Vector3& axis) {
    AxisApproach nearest{interval.begin, -1};
    for (const double s : {interval.begin, interval.end, extremal_angle(ray, apex, axis)}) {
        if (!(s >= interval.begin && s <= interval.end)) continue;
        const Vector3 x = ray.at(s) - apex;
        const double cosine = glm::dot(x, axis) / glm::length(x);
        if (cosine > nearest.cosine) nearest = {s, cosine};  // not at the apex itself: NaN
    }
    return nearest;
}

void append_nearest_to_axis(const Ray& ray, const Point3& apex, const Vector3& axis,
                            std::vector<double>& s) {
    const double root = extremal_angle(ray, apex, axis);
    if (std::isfinite(root) && root > 0) s.push_back(root);
}

}  // namespace uw
