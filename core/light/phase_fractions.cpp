#include "core/light/phase_fractions.h"

#include <cstddef>

namespace uw {

std::vector<double> typical_phase_fractions(const Medium& medium) {
    std::vector<double> fractions(medium.phase_functions.size(), 0.0);
    const auto bands = static_cast<std::size_t>(medium.band_count());
    const auto include = [&](const OpticalCoefficients& coefficients) {
        double all = 0;
        for (const Spectrum& b : coefficients.scattering)
            for (const double value : b.first(bands)) all += value;
        if (!(all > 0)) return;
        for (std::size_t m = 0; m < fractions.size(); ++m)
            for (const double value : coefficients.scattering[m].first(bands))
                fractions[m] += value / all;
    };
    include(medium.uniform);
    for (const Constituent& constituent : medium.constituents) include(constituent.per_unit);
    double sum = 0;
    for (const double fraction : fractions) sum += fraction;
    for (double& fraction : fractions) fraction = sum > 0 ? fraction / sum : 0;
    return fractions;
}

}  // namespace uw
