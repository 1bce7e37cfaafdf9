#pragma once

#include <string>

#include "cli/info/survey.h"

namespace uw {

/// A survey for people, ASCII.
std::string survey_text(const SceneSurvey& survey);

}  // namespace uw
