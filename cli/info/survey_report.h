#pragma once

#include "cli/info/scene_survey.h"
#include "cli/report.h"

namespace uw {

/// The survey of a scene, and the warnings about it (docs/command-line.md has the keys).
Report report_on_scene(const SceneSurvey& survey);

}  // namespace uw
