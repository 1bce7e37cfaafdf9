#include "cli/render/render_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "cli/console.h"
#include "cli/progress.h"
#include "cli/render/apply_arguments.h"
#include "cli/render/frame_renderer.h"
#include "cli/render/frame_sequence.h"
#include "cli/render/image_output.h"
#include "cli/render/resume.h"
#include "cli/render/stats.h"
#include "cli/stop_signal.h"
#include "cli/text_files.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/image/contact_sheet.h"
#include "core/image/image_writer.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

std::vector<std::string> names_of(const std::vector<LampDesc>& lamps) {
    std::vector<std::string> names;
    names.reserve(lamps.size());
    for (const LampDesc& lamp : lamps) names.push_back(lamp.name);
    return names;
}

PixelWindow window_of(const RenderArguments& a, const CameraDesc& camera) {
    if (!a.crop) return {0, 0, camera.width, camera.height};
    const auto [x0, y0, x1, y1] = *a.crop;
    if (x0 < 0 || y0 < 0 || x1 > camera.width || y1 > camera.height || x0 >= x1 || y0 >= y1)
        throw UsageError(
            fmt::format("--crop {},{},{},{}: not a window of the image of {} x {} pixels", x0, y0,
                        x1, y1, camera.width, camera.height));
    return {x0, y0, x1, y1};
}

// The pixels that are written, by camera.
std::vector<PixelWindow> windows_of(const RenderArguments& a, const SceneDesc& desc) {
    if (desc.cameras.empty()) return {window_of(a, desc.camera)};
    std::vector<PixelWindow> windows;
    for (const RigCameraDesc& entry : desc.cameras)
        windows.push_back(a.camera.empty() || a.camera == entry.name ? window_of(a, entry.camera)
                                                                     : PixelWindow{});
    return windows;
}

bool is_whole(const PixelWindow& window, const CameraDesc& camera) {
    return window == PixelWindow{0, 0, camera.width, camera.height};
}

// Warnings about the run that need nothing of the scene loaded.
void append_warnings(const RenderArguments& a, const Frame& first,
                     const std::vector<PixelWindow>& windows, SceneDesc& desc) {
    if (const auto warning = frame_warning(a, desc)) desc.warnings.push_back(*warning);
    const CameraDesc& camera =
        desc.cameras.empty() ? desc.camera : desc.cameras[first.camera].camera;
    if (desc.water.forward_scatter.K > 0 && !is_whole(windows[first.camera], camera))
        desc.warnings.push_back(
            "--crop: forward scatter takes light from the whole image: all of it is rendered, then "
            "cropped; set water.forward_scatter.K=0 to save that time");
}

// The scenes of frames one after the other, each resolved once. The first is resolved before
// anything is rendered: its lamps name layers, and all frames must have the same.
class FrameScenes {
  public:
    FrameScenes(const SceneDesc& desc, const Frame& first)
        : desc_(desc),
          first_choice_(first.choice()),
          first_(scene_of_image(desc, first_choice_)),
          lamp_names_(names_of(first_->desc().lamps)) {}

    const SceneDesc& first() const { return first_->desc(); }

    ResolvedScene take(const Frame& frame) {
        std::optional<ResolvedScene> first = std::exchange(first_, std::nullopt);
        if (first && frame.choice() == first_choice_) return std::move(*first);
        ResolvedScene scene(scene_of_image(desc_, frame.choice()));
        const std::vector<std::string> names = names_of(scene.desc().lamps);
        if (names != lamp_names_)
            throw InputError(fmt::format(
                "frame {}: its lamps are {}, but those of the first frame are {}; export the same "
                "lights in all frames",
                frame.number.value_or(0), fmt::join(names, ", "), fmt::join(lamp_names_, ", ")));
        return scene;
    }

  private:
    const SceneDesc& desc_;
    ImageChoice first_choice_;
    std::optional<ResolvedScene> first_;  // until a frame is taken
    std::vector<std::string> lamp_names_;
};

// A row for each frame of a rig's cameras.
void write_contact_sheet(const FrameSequence& sequence, bool quiet) {
    if (sequence.contact_sheet.empty()) return;
    std::vector<std::filesystem::path> pictures;
    std::size_t cameras = 0;
    for (const Frame& frame : sequence.frames) {
        pictures.push_back(frame.files.picture());
        if (frame.number == sequence.frames.front().number) ++cameras;
    }
    write_png(sequence.contact_sheet,
              contact_sheet(pictures, cameras > 1 ? static_cast<int>(cameras) : 0), {});
    if (!quiet) print_message(fmt::format("wrote {}\n", sequence.contact_sheet.string()));
}

void check_measures(const RenderArguments& a, const SceneDesc& first, const PixelWindow& window) {
    if (a.numbers.empty() && a.parts.any())
        throw UsageError(fmt::format("--{}: says what --numbers measures; give --numbers as well",
                                     a.parts.pixels ? "part" : "object"));
    check_parts(a.parts, first, window);
}

// What was measured in the images done.
void write_numbers(const RenderArguments& a, const std::filesystem::path& file,
                   const std::vector<RunStats>& done) {
    if (a.numbers.empty() || done.empty()) return;
    if (a.prints_numbers()) {
        for (const RunStats& stats : done) print_output(stats.numbers_table());
        return;
    }
    std::string csv = RunStats::numbers_csv_header();
    for (const RunStats& stats : done) csv += stats.numbers_csv();
    write_text(file, csv, a.quiet);
}

// Renders all frames; `stats` are those of the first so far. Whatever ends the run, the frames that
// were rendered are written, and so added to `done`.
void render_frames(const FrameSequence& sequence, FrameScenes& scenes, FrameRenderer& renderer,
                   RunStats stats, const std::vector<RunStats>& done) {
    try {
        for (const Frame& frame : sequence.frames)
            renderer.render(frame, scenes.take(frame), std::exchange(stats, RunStats()));
        renderer.finish();
    } catch (const Interrupted&) {
        renderer.finish();
        if (done.empty()) throw;
        throw Interrupted(fmt::format("interrupted; {} of {} frames are done; --resume continues",
                                      done.size(), sequence.frames.size()));
    } catch (...) {
        renderer.finish();
        throw;
    }
}

}  // namespace

void run_render(const RenderArguments& typed) {
    RenderArguments a = typed;
    if (a.resume && a.frames.empty() && !a.all_frames)
        throw UsageError("--resume: only continues a sequence; give its --frames");
    const auto start = std::chrono::steady_clock::now();
    RunStats stats;
    const ThreadLimit limit(a.threads);
    a.exr();  // throws for a word that does not exist
    stats.begin_stage("scene");
    SceneDesc desc = load_scene(a.scene, a.overrides);
    apply_arguments(a, desc);
    if (a.all_frames) a.frames = all_frames(desc);
    FrameSequence sequence = frames_of(a);
    add_cameras(sequence, desc, a.camera);
    add_sensor_images(sequence, desc);
    const std::vector<PixelWindow> windows = windows_of(a, desc);
    append_warnings(a, sequence.frames.front(), windows, desc);
    FrameScenes scenes(desc, sequence.frames.front());
    layer_plan(scenes.first(), a.layers, a.paths());  // throws for what does not exist
    const FrameSequence all = sequence;
    std::optional<double> exposure;
    if (a.resume) exposure = leave_out_rendered(sequence, desc, a, windows);
    if (sequence.frames.empty()) {
        write_contact_sheet(all, a.quiet);
        return;
    }
    check_measures(a, scenes.first(), windows[sequence.frames.front().camera]);
    check_frames(sequence, desc);
    std::vector<RunStats> done;
    FrameRenderer renderer(
        a, desc, windows, sequence.frames.size(), [&](const Frame& frame, RunStats of_frame) {
            if (!frame.files.stats.empty())
                of_frame.write_json(frame.files.stats, desc.file.filename().string());
            done.push_back(std::move(of_frame));
        });
    if (exposure) renderer.keep_exposure(*exposure);
    const auto write_stats = [&] {
        write_numbers(a, sequence.numbers, done);
        if (!done.empty()) write_contact_sheet(all, a.quiet);
        if (!sequence.stats.empty() && !done.empty())
            RunStats::write_json(sequence.stats, a.scene.filename().string(), done);
    };
    try {
        render_frames(sequence, scenes, renderer, std::move(stats), done);
    } catch (...) {
        write_stats();  // of the frames done
        throw;
    }
    write_stats();
    if (a.quiet) return;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    print_message(fmt::format("done in {}, peak memory {:.0f} MB\n",
                              format_duration(elapsed.count()),
                              static_cast<double>(RunStats::peak_memory_bytes()) / 1e6));
}

Command render_command() {
    const auto arguments = std::make_shared<RenderArguments>();
    return {"render", "render a scene to a multi-layer EXR", k_render_examples,
            render_options(*arguments), [arguments] {
                install_stop_signal();
                run_render(*arguments);
                return k_exit_done;
            }};
}

}  // namespace uw
