#pragma once

#include <optional>

#include "cli/render/frame_sequence.h"
#include "cli/render/run_scenes.h"

namespace uw {

/// Removes the images that exist already (--resume), and prints which. Returns the exposure of
/// previews where it is the same for all and known: that of the first image, if it exists.
std::optional<double> leave_out_rendered(FrameSequence& sequence, RunScenes& scenes,
                                         const RenderArguments& arguments);

}  // namespace uw
