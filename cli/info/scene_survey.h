#pragma once

#include "cli/info/survey.h"

namespace uw {

/// Surveys an assembled scene, which outlives the result. Deterministic.
SceneSurvey survey_scene(const AssembledScene& scene);

}  // namespace uw
