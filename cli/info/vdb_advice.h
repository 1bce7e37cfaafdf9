#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/ray.h"
#include "media/vdb/vdb_inspect.h"

namespace uw {

/// What to make of a file's grids, in words and as a part of a scene.
struct VdbAdvice {
    std::vector<std::string> lines;  // one sentence or two each
    std::vector<std::string> map;    // the grids to map, as scenes address them; none: none is fit
    double scale = 1;                // to apply, 1 where the file's size is plausible
    double small_ppm = 0, large_ppm = 0;  // per unit of grid value
    std::vector<double> bands_nm;
    /// Of the mapped grids alone, with these concentrations, per band: through their densest
    /// part, along the world's axis that lies between the other two in this.
    std::vector<double> optical_depth;
    /// YAML, ready to paste into a scene; empty where nothing can be mapped.
    std::string volumes;
    Bounds bounds;       // of the mapped grids in the world, scaled [m]
    Point3 eye, target;  // a camera with a field of view of 50 degrees or more sees all of them
};

/// Advice on `inspection`; reads the grids to map once more, for their optical depth.
/// `file`: the file's name as the scene is to have it.
VdbAdvice advise_on_vdb(const VdbInspection& inspection, const std::filesystem::path& file);

/// How likely a grid of this name holds a concentration: 0 surely none, 1 something else that a
/// concentration may be told from (heat, flames), 2 unknown, 3 likely, 4 a density.
int concentration_likelihood(const std::string& name);

}  // namespace uw
