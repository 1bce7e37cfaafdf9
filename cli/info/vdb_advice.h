#pragma once

#include <filesystem>
#include <string>

#include "cli/info/advice.h"
#include "cli/info/frame_survey.h"
#include "media/vdb/vdb_inspect.h"

namespace uw {

/// Advice on one file; reads the grids to map once more and renders drafts of them. `file`: its
/// name to write into the scene.
VdbAdvice advise_on_vdb(const VdbInspection& inspection, const std::filesystem::path& file);

/// Advice on a whole sequence from the frames that were sampled, the same whichever of them is
/// looked at: its bounds and camera hold all of them, its concentrations suit the frame that holds
/// most. `pattern`: the name to write into the scene.
VdbAdvice advise_on_sequence(const FrameSurvey& frames, const std::filesystem::path& pattern);

}  // namespace uw
