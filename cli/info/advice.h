#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/info/plume_view.h"
#include "core/base/ray.h"

namespace uw {

/// How to use a file's grids, in words and as part of a scene.
struct VdbAdvice {
    std::vector<std::string> lines;  // one sentence or two each
    std::vector<std::string> map;    // the grids to map, as scenes address them; empty: none is fit
    std::optional<double> voxel_size;  // to give, where the file's is known to be wrong [m]
    double scale = 1;                  // to apply, 1 where the file's size is plausible
    Vector3 translate{0};  // to apply: 0, or what brings a faraway volume to the origin [m]
    double small_ppm = 0, large_ppm = 0;  // per unit of grid value
    std::vector<double> bands_nm;
    /// Of the mapped grids alone, with these concentrations, per band: through their densest part,
    /// along the world axis with the median value of this.
    std::vector<double> optical_depth;
    /// YAML, ready to paste into a scene; empty where nothing can be mapped.
    std::string volumes;
    Bounds bounds;  // of the mapped grids in the world, as placed by the block [m]
    /// Camera, lamps, floor and water that show the volume, and how clearly.
    PlumeView view;
    std::string scene;  // YAML, a whole scene of these and the volume; empty as `volumes` is
};

}  // namespace uw
