#include "core/paths/lamp_glow.h"

#include <algorithm>

#include "core/base/fast_exp.h"

namespace uw {

namespace {

// A lamp that shines elsewhere still fills the water around it with scattered light.
constexpr double k_least_relative = 0.1;
constexpr double k_least_radius = 0.01;  // m: keeps it finite at a lamp

// The lamp's distance and its relative intensity over that.
struct Nearness {
    double radius = 0, relative = 0;

    Nearness(const Lamp& lamp, const Point3& x) {
        const Vector3 from_lamp = x - lamp.position();
        radius = std::max(glm::length(from_lamp), k_least_radius);
        relative = std::max(lamp.relative_intensity(from_lamp), k_least_relative) / radius;
    }
};

}  // namespace

void LampGlow::spread(const Point3& x, const Vector3& direction, std::span<double> values) const {
    std::ranges::fill(values, 0.0);
    for (const Lamp& lamp : *optics_.scene().lamps) {
        const Nearness near(lamp, x);
        const Vector3 to_lamp = lamp.position() - x;
        const double along = glm::dot(to_lamp, direction);
        const double across = glm::length(to_lamp - along * direction);
        const double h = across / std::max(1e-12, std::hypot(along, across) + along);
        const double share = near.relative * tables_.spread_glow(h);
        for (std::size_t b = 0; b < values.size(); ++b)
            values[b] += share * lamp.axis_intensity()[b] *
                         exp_of_minus(optics_.attenuation().uniform[b] * near.radius);
    }
}

double LampGlow::of_lamp(std::size_t lamp, const Point3& x, const Spectrum& weights) const {
    const Lamp& source = (*optics_.scene().lamps)[lamp];
    const Nearness near(source, x);
    double sum = 0;
    for (std::size_t b = 0; b < optics_.bands(); ++b)
        sum += weights[b] * source.axis_intensity()[b] *
               exp_of_minus(optics_.attenuation().uniform[b] * near.radius);
    return sum * near.relative;
}

}  // namespace uw
