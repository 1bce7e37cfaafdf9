#pragma once

#include <cmath>
#include <numbers>

#include "core/optics/phase_function.h"

namespace uw {

/// The light that a white sphere with a diffuse surface scatters, as for the moon's phases: p =
/// 2/(3 pi^2) (sin psi - psi cos psi) (Lambert 1760; Schönberg 1929).
class LambertSphere final : public PhaseFunction {
  public:
    using PhaseFunction::evaluate;
    void evaluate(std::span<const double> psi, std::span<double> p) const override {
        for (std::size_t i = 0; i < psi.size(); ++i) p[i] = at(psi[i]);
    }
    std::string description() const override { return "diffuse spheres"; }

    static double at(double psi) {
        return 2 / (3 * std::numbers::pi * std::numbers::pi) *
               (std::sin(psi) - psi * std::cos(psi));
    }
};

}  // namespace uw
