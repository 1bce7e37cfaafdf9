#pragma once

#include <string>

#include "cli/info/scene_survey.h"

namespace uw {

/// A survey for people, ASCII.
std::string survey_text(const SceneSurvey& survey);

/// A survey as one JSON object (docs/command-line.md).
std::string survey_json(const SceneSurvey& survey);

}  // namespace uw
