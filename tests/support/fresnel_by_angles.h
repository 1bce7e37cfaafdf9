#pragma once

#include <cmath>

namespace uw::test {

/// Fractions of energy, for light polarised perpendicular (s) and parallel (p) to the plane of
/// incidence.
struct Polarised {
    double s, p;

    double mean() const { return 0.5 * (s + p); }
};

/// Fresnel's transmittance from index `n1` to `n2`, by angles instead of cosines:
/// R_s = sin^2(i - t) / sin^2(i + t) and R_p = tan^2(i - t) / tan^2(i + t). `incidence` > 0 [rad].
inline Polarised fresnel_by_angles(double incidence, double n1, double n2) {
    const double refracted = std::asin(n1 / n2 * std::sin(incidence));
    const double s = std::sin(incidence - refracted) / std::sin(incidence + refracted);
    const double p = std::tan(incidence - refracted) / std::tan(incidence + refracted);
    return {1 - s * s, 1 - p * p};
}

}  // namespace uw::test
