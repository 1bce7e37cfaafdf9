#include "core/light/phase_function.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uw {

HalfTangentDensity PhaseFunction::make_sampler() const {
    std::vector<double> density;
    for (const double h : HalfTangentDensity::nodes()) {
        const double dpsi = 2 / (1 + h * h), sine = h * dpsi;
        const double p = eval(2 * std::atan(std::clamp(h, k_min_half_tangent, k_max_half_tangent)));
        density.push_back(2 * std::numbers::pi * (p * dpsi) * sine);
    }
    return HalfTangentDensity(density);
}

}  // namespace uw
