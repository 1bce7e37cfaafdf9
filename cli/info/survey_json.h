#pragma once

#include <string>

#include "cli/info/survey.h"

namespace uw {

/// A survey as one JSON object (docs/command-line.md).
std::string survey_json(const SceneSurvey& survey);

}  // namespace uw
