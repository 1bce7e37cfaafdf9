#pragma once

#include <string>
#include <vector>

#include "render/validation/validation.h"

namespace uw {

/// The checks and the parts of the light as lines of text; failed checks are red if `colour` is
/// set.
std::string light_table(const LightValidation& light, bool colour);

/// The checks of one scene as lines of text; failed ones are red if `colour` is set.
std::string validation_table(const SceneValidation& scene, bool colour);

/// One self-contained HTML page: the tables, the pictures of every method, maps of their
/// differences, the convergence of the planes, and what is said of all light. Throws IoError.
std::string validation_page(const std::vector<SceneValidation>& scenes,
                            const std::vector<LightValidation>& lights);

}  // namespace uw
