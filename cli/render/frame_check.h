#pragma once

#include <functional>
#include <optional>

#include "cli/render/frame_sequence.h"

namespace uw {

/// The scene of a variation, until another is requested; without a number the scene itself.
using SceneOfVariation = std::function<const SceneDesc&(std::optional<int> variation)>;

/// Checks what all frames read and write before the first is rendered. Throws IoError that names
/// all frames whose files are missing; InputError for a frame that does not match the others (see
/// VolumeSequenceCheck); and as OutputCheck does.
void check_frames(const FrameSequence& sequence, const SceneOfVariation& scene_of);

}  // namespace uw
