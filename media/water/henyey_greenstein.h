#pragma once

#include "core/light/phase_function.h"

namespace uw {

/// p = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos psi)^1.5) (Henyey and Greenstein 1941), normalised
/// exactly.
class HenyeyGreenstein final : public PhaseFunction {
  public:
    /// `g`, the mean cosine, in (-1, 1); otherwise InputError.
    explicit HenyeyGreenstein(double g);

    using PhaseFunction::eval;
    void eval(std::span<const double> psi, std::span<double> p) const override;

    /// p is smooth, but its poles at psi = +-i ln(1/|g|) (from psi = 0, or pi for g < 0) lie so
    /// close to the real axis that one polynomial cannot follow the peak: splits at ratios of 3
    /// away from it, none for |g| < 0.5.
    std::vector<double> breakpoints() const override;

    std::string description() const override;

  private:
    double g_;
};

}  // namespace uw
