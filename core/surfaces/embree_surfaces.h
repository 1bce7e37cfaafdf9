#pragma once

#include <memory>

#include "core/surfaces/scene_objects.h"
#include "core/surfaces/surfaces.h"

namespace uw {

/// Builds Embree's acceleration structure over `objects` and keeps both. Embree finds the candidate
/// in single precision; distances and normals are computed again in double from the shapes. Equally
/// near candidates go by object and triangle number, so that results do not depend on the number of
/// threads the structure was built with. Throws std::runtime_error with Embree's text.
std::unique_ptr<Surfaces> make_embree_surfaces(SceneObjects objects);

}  // namespace uw
