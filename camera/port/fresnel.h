#pragma once

namespace uw {

/// The fraction of energy that a smooth surface transmits, for light polarised perpendicular (s)
/// and parallel (p) to the plane of incidence.
struct FresnelTransmittance {
    double s = 1;
    double p = 1;
};

/// Fresnel's equations between two transparent media (docs/physics.md, section 3): light meets the
/// surface from index `n1` with cosine `cos1` (0..1) to its normal and continues in index `n2`.
/// Energy, so 1 - s and 1 - p are reflected, and the reverse path has the same values. 0 on total
/// reflection and at grazing incidence.
FresnelTransmittance fresnel_transmittance(double cos1, double n1, double n2);

}  // namespace uw
