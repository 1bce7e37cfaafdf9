#pragma once

#include "core/light/phase_function.h"

namespace uw {

/// Scattering by the molecules of water and its salts, Einstein-Smoluchowski (Morel 1974):
/// p = (1 + 0.835 cos^2 psi) / (4 pi (1 + 0.835/3)), normalised exactly.
class MolecularPhase final : public PhaseFunction {
  public:
    /// Depolarisation factor of the cos^2 term.
    static constexpr double k_anisotropy = 0.835;

    using PhaseFunction::eval;
    void eval(std::span<const double> psi, std::span<double> p) const override;
    std::string description() const override;
};

}  // namespace uw
