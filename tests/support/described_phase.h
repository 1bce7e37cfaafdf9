#pragma once

#include <memory>
#include <string>
#include <vector>

#include "media/water/fournier_forand.h"
#include "media/water/henyey_greenstein.h"
#include "media/water/phase_functions.h"

namespace uw::test {

inline std::shared_ptr<const PhaseFunction> henyey_greenstein(double g) {
    return std::make_shared<HenyeyGreenstein>(g);
}

inline std::shared_ptr<const PhaseFunction> fournier_forand(double n, double mu) {
    return std::make_shared<FournierForand>(n, mu);
}

inline std::shared_ptr<const PhaseFunction> petzold_average() {
    std::vector<std::string> warnings;
    return make_phase_function({PetzoldDesc{}, "phase"}, warnings);
}

}  // namespace uw::test
