#pragma once

#include <optional>

#include "cli/command.h"
#include "cli/render/frame_sequence.h"
#include "cli/render/render_arguments.h"
#include "cli/render/run_scenes.h"

namespace uw {

/// Removes the images that exist already (--resume), and prints which. Returns the exposure of
/// previews where it is the same for all and known: that of the first image, if it exists.
std::optional<double> leave_out_rendered(FrameSequence& sequence, RunScenes& scenes,
                                         const RenderArguments& arguments);

/// `uwvdb render`: reads the scene, renders it and writes the EXR, its preview and whatever else
/// the arguments request, each file whole or not at all. Reports on stderr. Throws UsageError,
/// InputError and Interrupted, and then no file has been touched; IoError.
void run_render(const RenderArguments& arguments);

/// `uwvdb render` as the command line knows it.
Command render_command();

}  // namespace uw
