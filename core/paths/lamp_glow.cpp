#include "core/paths/lamp_glow.h"

#include <algorithm>

namespace uw {

namespace {

// A lamp that shines elsewhere still fills the water around it with scattered light.
constexpr double k_least_relative = 0.1;
constexpr double k_least_radius = 0.01;       // m: keeps it finite at a lamp
constexpr double k_least_attenuation = 1e-3;  // 1/m: keeps it finite in water without any

// The lamp's distance and its relative intensity over that.
struct Nearness {
    double radius = 0, relative = 0;

    Nearness(const Lamp& lamp, const Point3& x, double attenuation) {
        const Vector3 from_lamp = x - lamp.origin(x);
        radius = std::max(glm::length(from_lamp), k_least_radius);
        // A sun's light comes back from as far as one sees, a lamp's from around it.
        const double depth =
            lamp.sunlight() ? 1 / std::max(attenuation, k_least_attenuation) : radius;
        relative = std::max(lamp.relative_intensity(from_lamp), k_least_relative) * depth /
                   lamp.spread(radius);
    }
};

}  // namespace

double LampGlow::clearest() const {
    return optics_.attenuation().uniform[optics_.clearest_band()];
}

LampGlow::Spread LampGlow::spread(std::size_t lamp, const LampPassage& passage, double s,
                                  const Point3& x) const {
    const Nearness near((*optics_.scene().emitters)[lamp], x, clearest());
    const double h = passage.half_tangent(s, near.radius);
    return {near.relative * tables_.spread_glow(h), near.radius};
}

double LampGlow::of_lamp(std::size_t lamp, const Point3& x, const Spectrum& weights) const {
    const Lamp& source = (*optics_.scene().emitters)[lamp];
    const Nearness near(source, x, clearest());
    return near.relative * optics_.attenuated_sum(weights, source.axis_intensity(), near.radius);
}

}  // namespace uw
