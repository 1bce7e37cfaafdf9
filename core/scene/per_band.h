#pragma once

#include <vector>

namespace uw {

/// One value per band of the scene, in the order of WaterDesc::bands_nm.
using PerBand = std::vector<double>;

}  // namespace uw
