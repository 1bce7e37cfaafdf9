#pragma once

#include "cli/info/survey.h"

namespace uw {

/// Surveys an assembled scene, which outlives the result. `contrast`: from drafts of it, if any
/// were rendered. Deterministic.
SceneSurvey survey_scene(const AssembledScene& scene, const std::optional<DraftContrast>& contrast);

}  // namespace uw
