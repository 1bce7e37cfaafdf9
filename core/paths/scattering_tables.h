#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/light/medium.h"
#include "core/paths/half_tangent_density.h"

namespace uw {

/// The phase functions of a medium and the densities that random paths are drawn from.
struct ScatteringTables {
    PhaseTable phases;
    /// The rough share of each phase function in the scattering of all that the water may hold;
    /// their sum is 1.
    std::vector<double> shares;

    // One per phase function m of the medium:
    /// p_m(psi) over directions: the angle of a scattering.
    std::vector<HalfTangentDensity> directions;
    /// p_m(psi) over angles: where on a line the light of a lamp is scattered along it, since
    /// ds / R^2 = dpsi / D with D the lamp's distance from the line.
    std::vector<HalfTangentDensity> lines;
    /// int_psi^pi p_m over angles: the radiance of single-scattered light around a point lamp, as a
    /// function of the angle to it, times the sine of that angle.
    HalfTangentDensity lobe;
    /// int_psi^pi p_m over angles [1/sr], of the phase function that `lobe` is made of.
    double beyond(double half_tangent) const {
        return lobe.density(half_tangent) * 0.5 * (1 + half_tangent * half_tangent);
    }
    /// The radiance around a point lamp, beyond / sin(psi), spread by one more scattering:
    /// a convolution with the phase function, roughly [1/sr^2].
    double spread_glow(double half_tangent) const;

    explicit ScatteringTables(const Medium& medium);

    std::size_t phase_count() const { return lines.size(); }
    /// All p_m at `half_tangent` [1/sr].
    void phase(double half_tangent, std::span<double> p) const {
        phases.evaluate(std::span(&half_tangent, 1), p);
    }

  private:
    void spread();

    std::vector<double> spread_glow_;  // at quarters of the octaves of h from 2^-12 on
};

}  // namespace uw
