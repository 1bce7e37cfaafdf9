#pragma once

#include <string>

#include "cli/validate/light_check.h"
#include "cli/validate/validation.h"

namespace uw {

/// Compares the fast form of multiple scattering, an image of integrator volume, with unbiased
/// light paths (integrator path) at pixels drawn at random all over the image: the parts
/// multiple.volume and multiple.surface, and their sum, in units of both standard errors. The image
/// is that of `scene` with at most ValidationOptions::longest_side_of_all_light pixels a side.
/// Throws InputError, and Interrupted.
LightValidation validate_all_light(ResolvedScene scene, const std::string& name,
                                   const ValidationOptions& options);

}  // namespace uw
