#pragma once

#include <memory>
#include <string>
#include <vector>

#include "media/water/phase_functions.h"

namespace uw::test {

/// The phase function that a scene describes so.
inline std::shared_ptr<const PhaseFunction> phase_of(const PhaseFunctionDesc& function) {
    std::vector<std::string> warnings;
    return make_phase_function({function, "phase"}, warnings);
}

inline std::shared_ptr<const PhaseFunction> henyey_greenstein(double g) {
    return phase_of(HenyeyGreensteinDesc{g});
}

inline std::shared_ptr<const PhaseFunction> fournier_forand(double n, double mu) {
    return phase_of(FournierForandDesc{n, mu});
}

inline std::shared_ptr<const PhaseFunction> petzold_average() {
    return phase_of(PetzoldDesc{});
}

}  // namespace uw::test
