#include "core/light/line_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/numerics.h"

namespace uw {

LineProfile::LineProfile(const LineProfileDesc& desc, const LampPlacement& placement)
    : axis_(placement.axis()),
      along_(placement.across_in_world(desc.rotate)),
      normal_(glm::cross(axis_, along_)),
      half_angle_(glm::radians(0.5 * desc.angle)),
      deviation_(glm::radians(desc.width) / std::sqrt(8 * std::numbers::ln2)),
      dark_(2 * glm::radians(desc.width)) {}

double LineProfile::relative_intensity(const Vector3& v) const {
    const double along = glm::dot(v, along_), ahead = glm::dot(v, axis_);
    const double in_plane = std::hypot(along, ahead), off = glm::dot(v, normal_);
    const double angle = std::atan2(std::abs(off), in_plane);
    if (!(angle < dark_) || std::abs(std::atan2(along, ahead)) > half_angle_) return 0;
    const double deviations = angle / deviation_;
    return std::exp(-0.5 * deviations * deviations);
}

// In polar coordinates about the normal.
double LineProfile::solid_angle() const {
    constexpr int k_panels = 16;
    double sum = 0;
    for (int panel = 0; panel < k_panels; ++panel)
        for (const QuadratureNode& node : gauss_legendre(4)) {
            const double angle = (panel + node.position) / k_panels * dark_;
            const double deviations = angle / deviation_;
            sum += node.weight * std::exp(-0.5 * deviations * deviations) * std::cos(angle);
        }
    return 2 * half_angle_ * 2 * dark_ * sum / k_panels;
}

DirectionCone LineProfile::cone() const {
    const double end = std::cos(half_angle_);
    return {axis_, end > 0 ? end * std::cos(dark_) : end};
}

void LineProfile::append_ends(const Ray& ray, const Point3& apex, std::vector<double>& s) const {
    for (const double angle : {-half_angle_, half_angle_}) {
        const Vector3 end = std::cos(angle) * axis_ + std::sin(angle) * along_;
        append_half_plane_crossing(ray, apex, end, glm::cross(end, normal_), s);
    }
}

// A ray crosses the sheet at nearly the same distance from the lamp, so that its light is a
// Gaussian along the ray; one that never comes to its middle sees a part of it.
void LineProfile::append_breaks(const Ray& ray, const Interval& /*interval*/, const Point3& apex,
                                std::vector<double>& s) const {
    for (const double deviations : {0.3, 0.9, 1.5, 2.1, 2.7, 3.3, 4.0, dark_ / deviation_})
        for (const double side : {-1.0, 1.0})
            append_cone_crossings(ray, apex, normal_, side * std::sin(deviations * deviation_), s);
    append_nearest_to_axis(ray, apex, normal_, s);
    append_ends(ray, apex, s);
}

Interval LineProfile::beam(const Ray& ray, const Interval& interval, const Point3& apex) const {
    if (!(interval.length() > 0)) return interval;
    std::vector<double> cuts;
    cuts.reserve(8);
    for (const double side : {-1.0, 1.0})
        append_cone_crossings(ray, apex, normal_, side * std::sin(dark_), cuts);
    append_ends(ray, apex, cuts);
    return lit_part(ray, interval, cuts,
                    [&](const Point3& x) { return relative_intensity(x - apex) > 0; });
}

}  // namespace uw
