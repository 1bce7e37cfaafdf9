#pragma once

#include <span>
#include <string>
#include <vector>

namespace uw {

/// Angular distribution of scattered light, p(psi) in 1/sr, with 2 pi int p sin(psi) dpsi = 1. psi
/// is the angle between the light's directions of travel before and after scattering: 0 is forward,
/// pi is back towards the source (physics: cos psi = w_in . w_out).
class PhaseFunction {
  public:
    virtual ~PhaseFunction() = default;

    /// p at each angle `psi` [rad, 0..pi], into `p` of the same length.
    virtual void evaluate(std::span<const double> psi, std::span<double> p) const = 0;

    /// Angles [rad], ascending and inside (0, pi), where p is not smooth: quadrature should be
    /// split there.
    virtual std::vector<double> breakpoints() const { return {}; }

    /// Name and parameters for reports, e.g. "henyey-greenstein g=0.9".
    virtual std::string description() const = 0;

    double evaluate(double psi) const {
        double p = 0;
        evaluate(std::span<const double>(&psi, 1), std::span<double>(&p, 1));
        return p;
    }
};

}  // namespace uw
