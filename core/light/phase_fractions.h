#pragma once

#include <vector>

#include "core/light/medium.h"

namespace uw {

/// The typical fraction of each phase function in the scattering of all that the water may contain,
/// as one distribution for all of it; they add up to 1, or are 0 where nothing scatters.
std::vector<double> typical_phase_fractions(const Medium& medium);

}  // namespace uw
