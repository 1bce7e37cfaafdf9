#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/light/half_tangent_density.h"

namespace uw {

/// Angular distribution of scattered light, p(psi) in 1/sr, with 2 pi int p sin(psi) dpsi = 1. psi
/// is the angle between the light's directions of travel before and after scattering: 0 is forward,
/// pi is back towards the source (physics: cos psi = w_in . w_out).
class PhaseFunction {
  public:
    /// Tables of phase functions over h = tan(psi / 2) cover these: psi from 1.2e-7, below which
    /// none of ours varies by more than 2 %, to pi - 1e-4. Beyond them p is taken to be constant.
    static constexpr double k_min_half_tangent = 0x1p-24, k_max_half_tangent = 0x1p14;

    virtual ~PhaseFunction() = default;

    /// p at each angle `psi` [rad, 0..pi], into `p` of the same length.
    virtual void eval(std::span<const double> psi, std::span<double> p) const = 0;

    /// Angles [rad], ascending and inside (0, pi), where p is not smooth: quadrature should be
    /// split there.
    virtual std::vector<double> breakpoints() const { return {}; }

    /// Name and parameters for reports, e.g. "henyey-greenstein g=0.9".
    virtual std::string description() const = 0;

    double eval(double psi) const {
        double p = 0;
        eval(std::span<const double>(&psi, 1), std::span<double>(&p, 1));
        return p;
    }

    /// Tabulates p for drawing scattering angles: HalfTangentDensity::sample draws them and pdf is
    /// their density, which follows p to 2e-4 where p is smooth. One table serves every model, so
    /// that none needs an inverse of its own.
    HalfTangentDensity make_sampler() const;
};

}  // namespace uw
