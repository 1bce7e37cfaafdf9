#pragma once

#include <optional>
#include <vector>

#include "cli/render/frame_sequence.h"

namespace uw {

/// Removes the images that exist already (--resume), and prints which; `windows` are the pixels
/// written, by camera. Returns the exposure of previews where it is the same for all and known:
/// that of the first image, if it exists.
std::optional<double> leave_out_rendered(FrameSequence& sequence, const SceneDesc& desc,
                                         const RenderArguments& arguments,
                                         const std::vector<PixelWindow>& windows);

}  // namespace uw
