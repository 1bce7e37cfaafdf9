#include "cli/render/resume.h"

#include <fmt/format.h>

#include <utility>

#include "cli/console.h"
#include "cli/frame_list.h"
#include "core/image/image_reader.h"
#include "core/image/image_writer.h"
#include "render/image_header.h"

namespace uw {

namespace {

// Whether the preview of an image that exists is stored as requested; `exposure`: as it is to be,
// none: as it is.
bool has_preview(const OutputFiles& files, const RenderArguments& a,
                 const std::optional<double>& exposure) {
    const std::optional<PreviewHeader> header = read_preview_header(files.preview);
    return header && header->bits == (a.is_preview_16_bit ? 16 : 8) &&
           (!exposure || header->exposure == as_stated_in_png(*exposure));
}

}  // namespace

std::optional<double> leave_out_rendered(FrameSequence& sequence, RunScenes& scenes,
                                         const RenderArguments& a) {
    const PathRequest paths = a.paths();
    const ExrOptions storage = a.exr();
    std::vector<int> there;  // frames of the scene itself
    const char* noun = "";
    const std::size_t all = sequence.frames.size();
    std::vector<Frame> left;
    MeshSideFiles known;
    std::optional<double> exposure;
    if (a.exposure.kind == PreviewExposure::Kind::fixed) exposure = a.exposure.factor;
    for (Frame& frame : sequence.frames) {
        const SceneDesc scene = scene_of_image(scenes.of(frame.variation), frame.choice());
        // Headers describe the camera that was rendered, possibly a glTF file's.
        const auto is_image_of = [&](const std::filesystem::path& file) {
            const ResolvedScene resolved{SceneDesc(scene)};
            const ImageLayout layout{scene.camera.width, scene.camera.height, frame.window,
                                     layer_plan(resolved.desc(), a.layers, paths).channel_names(),
                                     storage};
            return has_header_of(file, layout, metadata_of(resolved.desc(), frame.number, paths));
        };
        const bool rendered = is_rendered(frame, input_files(scene, known), is_image_of) &&
                              has_preview(frame.files, a, exposure);
        if (rendered && !exposure && left.empty() &&
            a.exposure.kind == PreviewExposure::Kind::first) {
            exposure = read_preview_header(frame.files.preview)->exposure;
            if (*exposure == 1) exposure.reset();  // black
        }
        if (rendered && !frame.variation && (there.empty() || there.back() != *frame.number))
            there.push_back(*frame.number);
        noun = frame.variation || !frame.camera_name.empty() ? "images " : "";
        if (!rendered) left.push_back(std::move(frame));
    }
    sequence.frames = std::move(left);
    const std::size_t done = all - sequence.frames.size();
    if (done == 0 || a.quiet) return exposure;
    const std::string which =
        there.empty() ? fmt::format("{} of {} images are", done, all)
                      : fmt::format("{} {} {}", there.size() == 1 ? "frame" : "frames",
                                    format_frame_list(there), there.size() == 1 ? "is" : "are");
    print_message(
        fmt::format("resume: {} there already, {} {}left\n", which, sequence.frames.size(), noun));
    return exposure;
}

}  // namespace uw
