#include "core/lamps/spot_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/lamps/ray_crossings.h"

namespace uw {

namespace {

using Falloff = SpotProfileDesc::Falloff;

bool is_blenders(Falloff falloff) {
    return falloff == Falloff::blender || falloff == Falloff::blender_3_4;
}

double smoothstep(double x) {
    return x * x * (3.0 - 2.0 * x);
}

// 2 pi int smoothstep sin(theta) over the edge of a spot, from full (inner) to dark (outer).
double edge_solid_angle(double inner, double outer) {
    constexpr int k_steps = 256;  // Simpson on a cubic times a sine: accurate to 1e-9
    const double h = (outer - inner) / k_steps;
    double sum = 0;
    for (int i = 0; i <= k_steps; ++i) {
        const double simpson = (i == 0 || i == k_steps) ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
        sum +=
            simpson * smoothstep(1.0 - static_cast<double>(i) / k_steps) * std::sin(inner + i * h);
    }
    return 2.0 * std::numbers::pi * sum * h / 3.0;
}

}  // namespace

SpotProfile::SpotProfile(const SpotProfileDesc& desc, const LampPlacement& placement)
    : axis_(placement.axis()),
      falloff_(desc.falloff),
      dark_angle_(glm::radians(
          std::min(is_blenders(falloff_) ? 90.0 : 180.0, 0.5 * (desc.beam + desc.edge)))),
      cos_dark_(std::cos(dark_angle_)),
      full_angle_(glm::radians(std::max(0.0, 0.5 * (desc.beam - desc.edge)))),
      cos_full_(std::cos(full_angle_)) {
    if (is_blenders(falloff_)) {
        // Blend is a share of the angle in Blender's cones, but of 1 - cos in its shading.
        const double blend = 1 - full_angle_ / dark_angle_;
        cos_full_ = cos_dark_ + (1 - cos_dark_) * blend;
        full_angle_ = std::acos(std::min(1.0, cos_full_));
    }
    core_cones_.push_back(cos_full_);
    if (falloff_ != Falloff::blender_3_4) return;
    for (const double level : {0.95, 0.75, 0.5, 0.25, 0.1})  // within the core it is a cosine
        if (level > cos_full_) core_cones_.push_back(level);
}

double SpotProfile::relative_intensity(const Vector3& v) const {
    const double cosine = glm::dot(v, axis_) / glm::length(v);
    if (cosine <= cos_dark_) return 0.0;
    const double core = falloff_ == Falloff::blender_3_4 ? cosine : 1.0;
    if (cosine >= cos_full_) return core;
    const double ramp = (cosine - cos_dark_) / (cos_full_ - cos_dark_);
    if (falloff_ == Falloff::gltf) return ramp * ramp;
    if (is_blenders(falloff_)) return core * smoothstep(ramp);
    const double angle = std::acos(glm::clamp(cosine, -1.0, 1.0));
    return smoothstep((dark_angle_ - angle) / (dark_angle_ - full_angle_));
}

double SpotProfile::solid_angle() const {
    // Integrals over the cosine: of the core, and of the edge as a ramp from cos_dark_ on.
    const double width = cos_full_ - cos_dark_;
    const double full = 2.0 * std::numbers::pi * (1.0 - cos_full_);
    switch (falloff_) {
        case Falloff::gltf:  // int t^2 dt = 1/3
            return full + 2.0 * std::numbers::pi * width / 3.0;
        case Falloff::blender:  // int 3 t^2 - 2 t^3 dt = 1/2
            return full + std::numbers::pi * width;
        case Falloff::blender_3_4:  // and int 3 t^3 - 2 t^4 dt = 7/20
            return std::numbers::pi *
                   (1 - cos_full_ * cos_full_ + width * (cos_dark_ + 0.7 * width));
        case Falloff::smooth:
            break;
    }
    return full + edge_solid_angle(full_angle_, dark_angle_);
}

void SpotProfile::append_breaks(const Ray& ray, const Interval& stretch, const Point3& apex,
                                std::vector<double>& s) const {
    for (const double cosine : core_cones_) append_cone_crossings(ray, apex, axis_, cosine, s);
    if (cos_dark_ == cos_full_) return;
    const AxisApproach nearest = approach_to_axis(ray, stretch, apex, axis_);
    if (nearest.cosine <= cos_dark_) return;
    // Of the edge, what the ray comes to: one that grazes the beam sees only a narrow peak.
    double begin = full_angle_;
    if (nearest.cosine < cos_full_) {
        begin = std::acos(nearest.cosine);
        s.push_back(nearest.s);
    }
    for (const double part : {0.25, 0.5, 0.75, 1.0})
        append_cone_crossings(ray, apex, axis_, std::cos(begin + part * (dark_angle_ - begin)), s);
}

}  // namespace uw
