#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/render/output_files.h"
#include "cli/render/render_arguments.h"
#include "core/scene/scene_desc.h"
#include "render/input_files.h"
#include "render/resolved_scene.h"

namespace uw {

/// One image of a run.
struct Frame {
    std::optional<int> number;  // none: the run renders the scene as it is, without --frames
    OutputFiles files;
    std::size_t camera = 0;   // of a rig's, by its index
    std::string camera_name;  // empty: the scene has one camera

    ImageChoice choice() const { return {number, camera}; }
};

/// The images of a run, in the order they are rendered.
struct FrameSequence {
    std::vector<Frame> frames;
    std::filesystem::path stats;  // one file about all of them; empty: none, or one each
};

/// What the arguments ask for. Throws UsageError for several frames to one name, and for a name
/// whose ending is not that of its format.
FrameSequence frames_of(const RenderArguments& arguments);

/// Makes of every frame one for each camera of a rig, whose names stand in the place of {camera} in
/// the names of files, or before their ending. `only`: this camera alone; empty: all. What is the
/// same for all cameras, the irradiance, is written with the first. Throws UsageError for a camera
/// that there is not, and for a place in names without a rig.
void add_cameras(FrameSequence& sequence, const SceneDesc& scene, const std::string& only);

/// Looks at what all frames read and write before the first is rendered. Throws IoError that names
/// all frames whose files are missing; InputError for a frame that does not go with the others (see
/// VolumeSequenceCheck); what OutputCheck does.
void check_frames(const FrameSequence& sequence, const SceneDesc& scene);

/// Whether `frame`, one of a sequence, is there: all its files but the statistics are, the image is
/// one that `is_image_of` accepts, and none of `inputs` is newer than it. Those that are part of
/// the scene's hash are for `is_image_of` to look at.
bool is_rendered(const Frame& frame, const std::vector<InputFile>& inputs,
                 const std::function<bool(const std::filesystem::path& image)>& is_image_of);

/// A line of warning where names and frames do not go together though they can be rendered:
/// frames that are all alike, or names with a place for a number where there are no frames.
std::optional<std::string> frame_warning(const RenderArguments& arguments, const SceneDesc& scene);

}  // namespace uw
