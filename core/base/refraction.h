#pragma once

#include <cmath>
#include <optional>

#include "core/base/vector_math.h"

namespace uw {

/// The fraction of energy that a smooth surface transmits, for light polarised perpendicular (s)
/// and parallel (p) to the plane of incidence.
struct FresnelTransmittance {
    double s = 1;
    double p = 1;

    /// Of unpolarised light.
    double mean() const { return 0.5 * (s + p); }
};

/// Fresnel's equations between two transparent media (docs/physics.md, section 3): light meets the
/// surface from index `n1` with cosine `cos1` (0..1) to its normal and continues in index `n2`.
/// Energy, so 1 - s and 1 - p are reflected, and the reverse path has the same values. 0 on total
/// reflection and at grazing incidence.
inline FresnelTransmittance fresnel_transmittance(double cos1, double n1, double n2) {
    const double r = n1 / n2;
    const double cos2_squared = 1 - r * r * (1 - cos1 * cos1);
    if (!(cos1 > 0) || !(cos2_squared > 0)) return {0, 0};
    const double cos2 = std::sqrt(cos2_squared);
    // T = (n2 cos2) / (n1 cos1) |t|^2, in the form that shows its symmetry.
    const double passed = 4 * n1 * cos1 * n2 * cos2;
    const double across = n1 * cos1 + n2 * cos2;
    const double in_plane = n2 * cos1 + n1 * cos2;
    return {passed / (across * across), passed / (in_plane * in_plane)};
}

/// Snell's law in vector form (docs/physics.md, section 3): `direction` (unit) crosses from index
/// `n1` to `n2` through a surface whose unit `normal` points along the light (direction .
/// normal > 0). Unit result; empty on total reflection. Nothing is singular at normal incidence,
/// and equal indices leave the direction unchanged.
inline std::optional<Vector3> refract(const Vector3& direction, const Vector3& normal, double n1,
                                      double n2) {
    const double r = n1 / n2;
    const double cos1 = glm::dot(direction, normal);
    const double cos2_squared = 1 - r * r * (1 - cos1 * cos1);
    if (!(cos2_squared > 0)) return std::nullopt;
    // sqrt(cos2^2) - r cos1, written without the difference: nothing cancels, and r = 1 gives 0.
    const double along_normal = (1 - r) * (1 + r) / (std::sqrt(cos2_squared) + r * cos1);
    return glm::normalize(r * direction + along_normal * normal);
}

}  // namespace uw
