#include "cli/render/render_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "cli/console.h"
#include "cli/image_choice.h"
#include "cli/process.h"
#include "cli/render/frame_renderer.h"
#include "cli/render/frame_sequence.h"
#include "cli/render/image_output.h"
#include "cli/render/render_arguments.h"
#include "cli/render/run_scenes.h"
#include "cli/render/run_stats.h"
#include "core/base/error.h"
#include "core/base/output_files.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "core/image/colour_view.h"
#include "core/image/contact_sheet.h"
#include "core/image/image_file.h"
#include "render/image_header.h"

namespace uw {

namespace {

// Whether a file has been changed after `time`, or cannot be told to be older.
bool is_newer(const std::filesystem::path& file, std::filesystem::file_time_type time) {
    std::error_code error;
    const auto written = std::filesystem::last_write_time(file, error);
    return error || written > time;
}

// Whether the preview of an image that was rendered at `time` is stored as requested; `exposure`:
// as it is to be, none: as it is.
bool has_preview(const OutputFiles& files, const RenderArguments& a,
                 const std::optional<double>& exposure, const std::optional<ViewDesc>& desc,
                 std::filesystem::file_time_type time) {
    const std::shared_ptr<const ColourView> view = colour_view(desc);
    if (view &&
        std::ranges::any_of(view->files, [&](const auto& file) { return is_newer(file, time); }))
        return false;
    const std::optional<PreviewHeader> header = read_preview_header(files.preview);
    return header && header->bits == a.preview_bits.value_or(8) &&
           header->view == (view ? view->name : "") &&
           (!exposure || header->exposure == as_stated_in_png(*exposure));
}

// Removes the images that exist already (--resume), and prints which. Keeps the first image's
// exposure, if that exists.
void leave_out_rendered(FrameSequence& sequence, RunScenes& scenes, const RenderArguments& a,
                        RunExposure& exposure) {
    const PathRequest paths = a.paths();
    const ExrOptions storage = a.exr();
    const auto is_wanted = [&](const Frame& frame, std::filesystem::file_time_type time) {
        // Headers describe the camera that was rendered, possibly a glTF file's.
        const ImageScene scene = scene_of_image(scenes.of(frame.variation), frame.image().choice);
        const CameraDesc& camera = scene.desc().camera;
        const ImageLayout layout{camera.width, camera.height, frame.window,
                                 a.is_aces ? std::vector<std::string>{"R", "G", "B", "A"}
                                           : layer_plan(scene, a.layers, paths).channel_names(),
                                 storage};
        return has_header_of(frame.files.image, layout, metadata_of(scene, frame.number, paths)) &&
               has_preview(frame.files, a, exposure.of_all(), scene.desc().render.view, time);
    };
    InputTimes inputs(scenes.job());
    std::vector<int> there;  // frames of the scene itself
    bool is_of_frames = true;
    const std::size_t all = sequence.frames.size();
    std::vector<Frame> left;
    for (Frame& frame : sequence.frames) {
        const auto time = time_rendered(frame);
        const bool rendered =
            time && inputs.last_change(frame.image()) <= *time && is_wanted(frame, *time);
        if (rendered && left.empty()) {
            const double first = read_preview_header(frame.files.preview)->exposure;
            if (first != 1) exposure.keep(first);  // or it is black
        }
        if (rendered && !frame.variation && (there.empty() || there.back() != *frame.number))
            there.push_back(*frame.number);
        is_of_frames = !frame.variation && frame.camera_name.empty();
        if (!rendered) left.push_back(std::move(frame));
    }
    sequence.frames = std::move(left);
    const std::size_t done = all - sequence.frames.size();
    if (done == 0 || a.quiet) return;
    const std::string which =
        there.empty()
            ? fmt::format("{} of {} {}", done, counted(all, "image"), done == 1 ? "is" : "are")
            : fmt::format("{} {} {}", there.size() == 1 ? "frame" : "frames",
                          format_frame_list(there), there.size() == 1 ? "is" : "are");
    print_message(fmt::format("resume: {} there already, {} left\n", which,
                              is_of_frames ? std::to_string(sequence.frames.size())
                                           : counted(sequence.frames.size(), "image")));
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

// Sets the pixels that are written.
void set_windows(FrameSequence& sequence, const RenderArguments& a, const SceneDesc& desc) {
    for (Frame& frame : sequence.frames)
        frame.window =
            window_of(a, desc.cameras.empty() ? desc.camera : desc.cameras[frame.camera].camera);
}

// Warnings about the run that need nothing of the scene loaded.
std::vector<std::string> warnings_of(const RenderArguments& a, const Frame& first,
                                     const SceneDesc& desc, const RunScenes& scenes) {
    std::vector<std::string> warnings;
    if (const auto warning = frame_warning(a, desc)) warnings.push_back(*warning);
    const CameraDesc& camera =
        desc.cameras.empty() ? desc.camera : desc.cameras[first.camera].camera;
    const PixelWindow whole{0, 0, camera.width, camera.height};
    if (desc.water.forward_scatter.K > 0 && first.window != whole)
        warnings.emplace_back(
            "--crop: forward scatter takes light from the whole image: all of it is rendered, then "
            "cropped; set water.forward_scatter.K=0 to save that time");
    if (!a.is_scene_itself() && has_sensor(desc) &&
        std::ranges::none_of(drawn_keys(*scenes.variations().desc()),
                             [](const auto& key) { return key.ends_with("sensor.seed"); }))
        warnings.emplace_back(
            "variations: the camera's noise is the same in all of them; draw its seed, too: "
            "camera.sensor.seed: {integer: [0, 2000000000]}");
    return warnings;
}

// A row for each frame of a rig's cameras, or each variation's frames.
void write_contact_sheet(const FrameSequence& sequence, bool quiet) {
    if (sequence.contact_sheet.empty()) return;
    std::vector<std::filesystem::path> pictures;
    int cameras = 0, frames = 0;  // of the first frame, of the first variation
    const Frame& first = sequence.frames.front();
    for (const Frame& frame : sequence.frames) {
        pictures.push_back(frame.files.picture());
        if (frame.variation != first.variation) continue;
        ++frames;
        if (frame.number == first.number) ++cameras;
    }
    const int row = cameras > 1 ? cameras : first.variation && frames > 1 ? frames : 0;
    try {
        const StopScope scope(stop_flag());
        write_png(sequence.contact_sheet, contact_sheet(pictures, row), {});
    } catch (const Interrupted&) {
        throw Interrupted("interrupted; all images are done, but not their contact sheet");
    }
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

// All images that are to be rendered, of which the manifest is told as well, and of those of its
// set that are not.
FrameSequence images_of(const RenderArguments& a, RunScenes& scenes, VariationManifest& manifest) {
    FrameSequence sequence = frames_of(a);
    const std::vector<Frame> frames = std::exchange(sequence.frames, {});
    for (const std::optional<int> variation : scenes.all()) {
        const SceneDesc& desc = scenes.of(variation);
        FrameSequence of_scene = sequence;
        of_scene.frames = frames;
        if (variation) set_variation(of_scene, *variation);
        add_cameras(of_scene, desc, a.camera);
        add_sensor_images(of_scene, desc);
        if (variation) manifest.add(*variation, *scenes.variations().desc(), desc.hash, of_scene);
        sequence.stats = of_scene.stats;
        if (!scenes.is_wanted(variation)) continue;
        if (variation && !a.variation_count && !a.quiet)  // which no manifest lists
            print_message(fmt::format("variation {}: {}\n", *variation,
                                      values_text(scenes.variations().values(*variation))));
        set_windows(of_scene, a, desc);
        std::ranges::move(of_scene.frames, std::back_inserter(sequence.frames));
    }
    manifest.name_files(sequence);
    return sequence;
}

void run_render(const RenderArguments& typed) {
    RenderArguments a = typed;
    if (a.resume && a.frames.empty() && !a.all_frames && a.is_scene_itself())
        throw UsageError("--resume: only continues a sequence; give its --frames or --variations");
    const auto start = std::chrono::steady_clock::now();
    RunStats stats;
    const ThreadLimit limit(a.threads);
    a.exr();  // throws for a word that does not exist
    stats.begin_stage("scene");
    RunScenes scenes(a);
    if (a.all_frames) a.frames = all_frames(scenes.of(scenes.all().front()));
    VariationManifest manifest(a);
    FrameSequence sequence = images_of(a, scenes, manifest);
    const Frame first = sequence.frames.front();
    for (std::string& line : warnings_of(a, first, scenes.of(first.variation), scenes))
        scenes.job().warn(std::move(line));
    // Its lamps name layers, and all frames must have the same.
    const ImageScene first_scene = scenes.job().look_at(first.image());
    layer_plan(first_scene, a.layers, a.paths());  // throws for what does not exist
    const FrameSequence all = sequence;
    RunExposure exposure(a.exposure);
    if (a.resume) leave_out_rendered(sequence, scenes, a, exposure);
    if (sequence.frames.empty()) {
        std::set<std::filesystem::path> folders;
        for (const Frame& frame : all.frames) folders.insert(frame.files.main().parent_path());
        for (const auto& folder : folders) AtomicFile::remove_left_overs(folder);
        manifest.write(a.quiet);
        write_contact_sheet(all, a.quiet);
        return;
    }
    check_measures(a, first_scene.desc(), sequence.frames.front().window);
    check_frames(sequence, scenes.job());
    manifest.write(a.quiet);
    std::size_t done = 0;
    // Kept only if they are asked for: there may be many thousands.
    const bool keeps_stats = !sequence.stats.empty() || !a.numbers.empty();
    std::vector<RunStats> all_stats;
    FrameRenderer renderer(a, sequence.frames, names_of(first_scene.desc().lamps), exposure,
                           std::move(stats), [&](const Frame& frame, RunStats of_frame) {
                               if (!frame.files.stats.empty())
                                   of_frame.write_json(frame.files.stats,
                                                       a.scene.filename().string());
                               ++done;
                               if (keeps_stats) all_stats.push_back(std::move(of_frame));
                           });
    const auto write_stats = [&] {
        write_numbers(a, sequence.numbers, all_stats);
        if (!sequence.stats.empty() && done > 0)
            RunStats::write_json(sequence.stats, a.scene.filename().string(), all_stats);
    };
    try {
        renderer.run(scenes.job());
    } catch (const Interrupted&) {
        write_stats();  // of the frames done
        if (done == 0) throw;
        throw Interrupted(fmt::format("interrupted; {} of {} {} done; --resume continues", done,
                                      counted(sequence.frames.size(), "frame"),
                                      done == 1 ? "is" : "are"));
    } catch (...) {
        write_stats();
        throw;
    }
    write_stats();
    write_contact_sheet(all, a.quiet);
    if (a.quiet) return;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    print_message(fmt::format("done in {}, peak memory {:.0f} MB\n",
                              format_duration(elapsed.count()),
                              static_cast<double>(RunStats::peak_memory_bytes()) / 1e6));
}

}  // namespace

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
