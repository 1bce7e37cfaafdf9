#pragma once

#include <memory>

#include "core/geometry/scene_objects.h"
#include "core/geometry/surfaces.h"

namespace uw {

/// Builds Embree's acceleration structure over `objects` and owns both. Embree finds the candidate
/// in single precision; distances and normals are recomputed in double from the shapes. Ties
/// between equally near candidates are broken by object and triangle number, so that results do not
/// depend on the number of threads used to build the structure. Throws std::runtime_error with
/// Embree's message.
std::unique_ptr<Surfaces> make_embree_surfaces(SceneObjects objects);

}  // namespace uw
