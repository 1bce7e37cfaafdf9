#include "media/water/molecular_phase.h"

#include <cmath>
#include <numbers>

namespace uw {

void MolecularPhase::eval(std::span<const double> psi, std::span<double> p) const {
    constexpr double k_scale = 1 / (4 * std::numbers::pi * (1 + k_anisotropy / 3));
    for (std::size_t i = 0; i < psi.size(); ++i) {
        const double cosine = std::cos(psi[i]);
        p[i] = k_scale * (1 + k_anisotropy * cosine * cosine);
    }
}

std::string MolecularPhase::description() const {
    return "einstein-smoluchowski";
}

}  // namespace uw
