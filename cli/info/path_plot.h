#pragma once

#include <string>

#include "cli/info/path_survey.h"

namespace uw {

/// A map of the camera's path over the outlines of the surfaces as seen from above, and its height
/// over what is below, as an SVG document. `title`: the scene's name.
std::string path_plot(const PathSurvey& path, const Surfaces& surfaces, const std::string& title);

}  // namespace uw
