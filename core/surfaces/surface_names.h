#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace uw {

/// The name of an object or material of a scene's surfaces.
struct SurfaceName {
    std::string name;       // as in the file; not unique
    std::size_t entry = 0;  // of `geometry`, from 0
};

/// What the numbers in the layers `id` and `material` stand for: the first has number 1.
struct SurfaceNames {
    std::vector<SurfaceName> objects, materials;
};

}  // namespace uw
