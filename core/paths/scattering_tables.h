#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/light/medium.h"

namespace uw {

/// One of several alternatives, drawn at random.
struct Choice {
    std::size_t index = 0;
    double probability = 1;
};

/// Chooses between alternatives with the weights whose running sums are `cumulative` (not empty,
/// the last > 0). `u` in [0, 1) is replaced by a number that is again uniform in [0, 1).
inline Choice choose(std::span<const double> cumulative, double& u) {
    const double target = u * cumulative.back();
    std::size_t index = 0;
    while (index + 1 < cumulative.size() && cumulative[index] <= target) ++index;
    const double before = index == 0 ? 0.0 : cumulative[index - 1];
    const double weight = cumulative[index] - before;
    u = weight > 0 ? std::clamp((target - before) / weight, 0.0, 1.0) : 0.0;
    return {index, weight / cumulative.back()};
}

/// A density over scattering angles psi that can be sampled, in h = tan(psi / 2): linear in h
/// between nodes, 16 to an octave, from h = 2^-24 (psi = 1.2e-7) to 2^24, and down to h = 0. What
/// is drawn from it has exactly the density that `density` returns, so that estimates are unbiased
/// whatever it was made to follow. Not normalised: `mass` is its integral.
class HalfTangentDensity {
  public:
    /// The nodes, ascending from 0.
    static std::span<const double> nodes();

    HalfTangentDensity() = default;
    /// `at_nodes`: the density per unit of h at each node, >= 0.
    explicit HalfTangentDensity(std::span<const double> at_nodes);

    /// The integral over all h.
    double mass() const { return mass_; }
    /// The integral from 0 to `h` >= 0; infinity is allowed.
    double mass_to(double h) const;
    /// The density per unit of h at `h` >= 0; 0 beyond the last node.
    double density(double h) const;
    /// The h up to which the integral is `mass`, 0 <= mass <= mass().
    double invert(double mass) const;

  private:
    /// Between two nodes: all that a look-up needs, in half a cache line.
    struct Cell {
        double begin = 0, before = 0;  // its first node, and the integral up to there
        double value = 0, slope = 0;   // the density at `begin`, and its derivative
    };

    std::vector<Cell> cells_;            // and one of width 0 that ends them
    std::vector<std::uint16_t> guides_;  // the cell of each of as many equal parts of the mass
    double mass_ = 0;
    double guides_per_mass_ = 0;
};

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
