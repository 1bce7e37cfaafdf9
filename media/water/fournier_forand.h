#pragma once

#include <array>
#include <cstddef>

#include "core/light/phase_function.h"
#include "media/water/tabulated_phase.h"

namespace uw {

/// The Fournier-Forand phase function of particles with index `n` relative to water and a
/// hyperbolic (Junge) size distribution of slope `mu`, in the form of Fournier and Jonasz (1999),
/// Mobley's "Light and Water" web book:
///
///     p = [nu(1-d) - (1-d^nu) + (d(1-d^nu) - nu(1-d)) / sin^2(psi/2)] / (4 pi (1-d)^2 d^nu)
///         + (1-d180^nu) (3 cos^2 psi - 1) / (16 pi (d180-1) d180^nu),
///     nu = (3-mu)/2,  d = 4 sin^2(psi/2) / (3 (n-1)^2),  d180 = d at psi = pi.
///
/// The first term is 0/0 at d = 1; near it the quotients are evaluated by their binomial series. p
/// is unbounded as psi approaches 0. Below `k_min_angle` it is continued linearly in sin^2(psi/2),
/// without a step and with the integral over that cone (known in closed form), so that it is finite
/// everywhere and the whole integral is still 1.
class FournierForand final : public PhaseFunction {
  public:
    /// `n` in (1, 10]; `mu` in (3, 5), where the total scattering of the size distribution is
    /// finite. Otherwise InputError.
    FournierForand(double n, double mu);

    using PhaseFunction::eval;
    void eval(std::span<const double> psi, std::span<double> p) const override;

    /// The edge of the constant cone, then splits at ratios of 4: p is nearly a power of psi there,
    /// which no polynomial can follow over decades.
    std::vector<double> breakpoints() const override;

    std::string description() const override;

  private:
    static constexpr double k_min_angle = TabulatedPhase::k_min_angle;
    static constexpr std::size_t k_series_terms = 12;

    double value(double sin2_half) const;

    double n_, mu_, nu_;
    double delta_180_;
    double back_;  // factor of (3 cos^2 psi - 1)
    // p at sin^2(psi/2) = s2 inside k_min_angle is core_ - core_slope_ s2.
    double core_, core_slope_;
    std::array<double, k_series_terms> series_a_{}, series_b_{};
};

}  // namespace uw
