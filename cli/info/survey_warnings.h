#pragma once

#include "cli/info/survey.h"

namespace uw {

/// Appends to `survey.warnings` one line for each thing that will be black, opaque or missing.
void append_survey_warnings(SceneSurvey& survey);

}  // namespace uw
