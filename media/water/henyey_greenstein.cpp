#include "media/water/henyey_greenstein.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"

namespace uw {

HenyeyGreenstein::HenyeyGreenstein(double g) : g_(g) {
    if (!(g > -1 && g < 1))
        throw InputError(
            fmt::format("Henyey-Greenstein g = {} is out of range; give -1 < g < 1", g));
}

void HenyeyGreenstein::eval(std::span<const double> psi, std::span<double> p) const {
    const double scale = (1 - g_) * (1 + g_) / (4 * std::numbers::pi);
    const double nearest = (1 - g_) * (1 - g_);
    for (std::size_t i = 0; i < psi.size(); ++i) {
        // 1 + g^2 - 2 g cos(psi), without cancellation at small psi
        const double s = std::sin(0.5 * psi[i]);
        const double q = nearest + 4 * g_ * s * s;
        p[i] = scale / (q * std::sqrt(q));
    }
}

std::vector<double> HenyeyGreenstein::breakpoints() const {
    std::vector<double> angles;
    if (std::abs(g_) < 0.5) return angles;
    for (double angle = -std::log(std::abs(g_)); angle < 0.5 * std::numbers::pi; angle *= 3)
        angles.push_back(g_ > 0 ? angle : std::numbers::pi - angle);
    if (g_ < 0) std::reverse(angles.begin(), angles.end());
    return angles;
}

std::string HenyeyGreenstein::description() const {
    return fmt::format("henyey-greenstein g={}", g_);
}

}  // namespace uw
