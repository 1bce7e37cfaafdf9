#pragma once

#include <array>

namespace uw {

/// Most wavelength bands a scene may have; the number in use is a run-time property of the medium.
inline constexpr int k_max_bands = 32;

/// One value per wavelength band, in the order of `water.bands`; entries past the scene's band
/// count are zero and not read.
using Spectrum = std::array<double, k_max_bands>;

}  // namespace uw
