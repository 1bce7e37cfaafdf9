#pragma once

#include <string>

#include "render/validation/validation.h"
#include "render/validation/validation_methods.h"

namespace uw {

/// As validate_scene in validation.h, but compares the volume integrator as `under_test` changes
/// it.
SceneValidation validate_scene(const ImageScene& scene, const std::string& name,
                               const ValidationOptions& options, const TransportChange& under_test);

}  // namespace uw
