#pragma once

#include <string>
#include <vector>

#include "core/base/ray.h"

namespace uw {

/// How to use a file's grids, in words and as part of a scene.
struct VdbAdvice {
    std::vector<std::string> lines;  // one sentence or two each
    std::vector<std::string> map;    // the grids to map, as scenes address them; empty: none is fit
    double scale = 1;                // to apply, 1 where the file's size is plausible
    double small_ppm = 0, large_ppm = 0;  // per unit of grid value
    std::vector<double> bands_nm;
    /// Of the mapped grids alone, with these concentrations, per band: through their densest part,
    /// along the world axis with the median value of this.
    std::vector<double> optical_depth;
    /// YAML, ready to paste into a scene; empty where nothing can be mapped.
    std::string volumes;
    Bounds bounds;       // of the mapped grids in the world, scaled [m]
    Point3 eye, target;  // a camera with a field of view of 50 degrees or more sees all of them
};

}  // namespace uw
