#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "core/base/vector_math.h"

namespace uw {

/// Two unit vectors that are perpendicular to a third one, and to each other (Duff et al. 2017).
struct Tangents {
    Vector3 u, v;

    explicit Tangents(const Vector3& axis) {
        const double sign = std::copysign(1.0, axis.z);
        const double a = -1 / (sign + axis.z), b = axis.x * axis.y * a;
        u = {1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x};
        v = {b, sign + axis.y * axis.y * a, -axis.y};
    }
};

/// One of several alternatives that was drawn at random, and the probability of drawing it.
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

/// A density over scattering angles psi that can be sampled by inversion, in h = tan(psi / 2):
/// linear in h between nodes, 16 to an octave from h = 2^-24 (psi = 1.2e-7) to 2^24, and from 0 to
/// the first. Samples have exactly the density that `density` returns, so that estimates are
/// unbiased however roughly it follows its model. Not normalised: `mass` is its integral.
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

    /// Draws h from the normalised density; `u` in [0, 1].
    double sample(double u) const { return invert(u * mass_); }
    /// The pdf of sample() per unit of h.
    double pdf(double h) const { return density(h) / mass_; }

  private:
    /// A piece between two nodes. It contains all that a look-up needs, in half a cache line.
    struct Cell {
        double begin = 0, before = 0;  // first node, and the integral up to there
        double value = 0, slope = 0;   // the density at `begin`, and its derivative
    };

    std::vector<Cell> cells_;            // followed by one of width 0
    std::vector<std::uint16_t> guides_;  // guide table: the cell at equal steps of mass
    double mass_ = 0;
    double guides_per_mass_ = 0;
};

/// The direction (unit) at the angle of h = tan(angle / 2) from `axis`; `azimuth` is a fraction
/// (0..1) of a full revolution around it.
Vector3 direction_around(const Vector3& axis, double h, double azimuth);

/// tan(angle / 2) between unit vectors, accurate for small angles; from 1e-16 to 1e7.
double half_tangent_between(const Vector3& a, const Vector3& b);

/// The factor from a density per unit of h, the same for all azimuths, to one per solid angle:
/// dOmega = 2 pi sin(psi) dpsi = 8 pi h / (1 + h^2)^2 dh.
inline double per_solid_angle(double h) {
    const double square = 1 + h * h;
    return square * square / (8 * std::numbers::pi * h);
}

}  // namespace uw
