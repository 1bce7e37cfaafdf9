#pragma once

#include <string>

#include "cli/info/scene_survey_data.h"

namespace uw {

/// Looks at an assembled scene. Deterministic.
SceneSurvey survey_scene(AssembledScene scene);

/// For people.
std::string survey_text(const SceneSurvey& survey);
/// The same as one JSON object (docs/command-line.md).
std::string survey_json(const SceneSurvey& survey);

}  // namespace uw
