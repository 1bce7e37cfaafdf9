#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/optics/medium.h"

namespace uw {

/// All phase functions of a medium, tabulated for the integrators' inner loop over h = tan(psi /
/// 2), which needs no trigonometry for points on a ray and whose logarithm resolves forward and
/// backward peaks equally well. Uses a parabola on each 64th of an octave: accurate to 1e-6, except
/// at the kinks of a tabulated phase function, where it is 2e-3 within one cell.
class PhaseTable {
  public:
    explicit PhaseTable(const Medium& medium);

    /// p_m of phase function m at each `half_tangent` >= 0 (infinity: psi = pi), into
    /// p[m * half_tangent.size() + i] [1/sr].
    void evaluate(std::span<const double> half_tangent, std::span<double> p) const;

  private:
    std::size_t phases_;
    std::vector<double> coefficients_;  // [(cell * phases + m) * 3 + power]
};

}  // namespace uw
