#include "cli/render/frame_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <system_error>
#include <vector>

#include "cli/frame_list.h"
#include "core/base/error.h"
#include "core/base/frame_pattern.h"
#include "core/base/text.h"
#include "media/volumes/volume_sequence.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& file) {
    std::error_code ignored;
    return fs::is_regular_file(file, ignored);
}

// Lists the frames that lack a file of a sequence in the scene.
class MissingFrames {
  public:
    void look(const SourceLocation& where, const fs::path& name, std::span<const Frame> frames) {
        std::vector<int> missing;
        for (const Frame& frame : frames)
            if (frame.camera == frames.front().camera &&
                !is_there(file_of_frame(name, *frame.number)))
                missing.push_back(*frame.number);
        if (missing.empty()) return;
        text_ += fmt::format("{}{}.file: '{}' has no file for {} {}", text_.empty() ? "" : "; ",
                             where, printable(name.string(), 300),
                             missing.size() == 1 ? "frame" : "frames", format_frame_list(missing));
    }
    void refuse() const {
        if (!text_.empty())
            throw IoError(text_ + "; choose --frames that exist, or add the missing files");
    }

  private:
    std::string text_;
};

void check_volumes(std::span<const Frame> frames, const SceneDesc& scene) {
    for (std::size_t v = 0; v < scene.volumes.size(); ++v) {
        if (!scene.volumes[v].is_sequence) continue;
        VolumeSequenceCheck check;
        for (const Frame& frame : frames)
            if (frame.camera == frames.front().camera)
                check.take(scene_of_image(scene, frame.choice()).volumes[v]);
    }
}

// The files of the numbered frames of one scene.
void check_sequences(std::span<const Frame> frames, const SceneDesc& scene) {
    MissingFrames missing;
    for (const VolumeDesc& volume : scene.volumes) {
        if (volume.is_sequence) missing.look(volume.where, volume.file, frames);
        if (volume.motion && volume.motion->is_sequence && volume.motion->file != volume.file)
            missing.look(volume.motion->where, volume.motion->file, frames);
    }
    for (const GeometryDesc& mesh : scene.geometry)
        if (mesh.is_sequence) missing.look(mesh.where, mesh.file, frames);
    missing.refuse();
    check_volumes(frames, scene);
}

}  // namespace

void check_frames(const FrameSequence& sequence, const SceneOfVariation& scene_of) {
    OutputCheck outputs;
    MeshSideFiles known;
    std::span<const Frame> left = sequence.frames;
    while (!left.empty()) {
        const auto end = std::ranges::find_if(
            left, [&](const Frame& frame) { return frame.variation != left.front().variation; });
        const auto count = static_cast<std::size_t>(end - left.begin());
        const std::span<const Frame> of_scene = left.first(count);
        left = left.subspan(count);
        const SceneDesc& scene = scene_of(of_scene.front().variation);
        if (of_scene.front().number) check_sequences(of_scene, scene);
        for (const Frame& frame : of_scene)
            outputs.take_inputs(input_files(scene_of_image(scene, frame.choice()), known));
    }
    for (const Frame& frame : sequence.frames) outputs.take_outputs(frame.files);
    OutputFiles about_all;
    about_all.stats = sequence.stats;
    about_all.numbers = sequence.numbers;
    about_all.contact_sheet = sequence.contact_sheet;
    about_all.manifest_csv = sequence.manifest_csv;
    about_all.manifest_json = sequence.manifest_json;
    outputs.take_outputs(about_all);
}

}  // namespace uw
