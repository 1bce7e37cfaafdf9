#include "cli/render/frame_renderer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <span>
#include <utility>

#include "cli/console.h"
#include "cli/grid_summary.h"
#include "cli/process.h"
#include "cli/render/image_output.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/colour_view.h"
#include "core/light/integrator_table.h"
#include "render/measures/irradiance_vdb.h"

namespace uw {

namespace {

// The errors of some bands one by one, those of many by their range; nothing of a single one.
std::string describe_bands(std::span<const double> errors, std::span<const double> bands_nm) {
    constexpr std::array k_colours{"red", "green", "blue"};  // LayerPlan's R, G and B
    constexpr std::size_t k_most = 6;
    if (errors.size() < 2) return "";
    if (errors.size() > k_most) {
        const auto [least, most] = std::ranges::minmax(errors);
        return fmt::format(" ({:.2g} to {:.2g} % of the bands')", 100 * least, 100 * most);
    }
    std::string text;
    for (std::size_t b = 0; b < errors.size(); ++b) {
        const std::string band =
            errors.size() == k_colours.size() ? k_colours[b] : fmt::format("{:g} nm", bands_nm[b]);
        text += fmt::format("{}{} {:.2g}", b == 0 ? "" : ", ", band, 100 * errors[b]);
    }
    return fmt::format(" ({} % of the bands')", text);
}

// "64 samples, error 1.83 %"; empty if no light paths have been traced.
std::string describe(const PathAccuracy& reached) {
    if (reached.samples == 0) return {};
    std::string text = counted(static_cast<std::size_t>(reached.samples), "sample");
    if (reached.error) text += fmt::format(", error {:.3g} %", 100 * *reached.error);
    return text;
}

}  // namespace

std::vector<std::string> names_of(const std::vector<LampDesc>& lamps) {
    std::vector<std::string> names;
    names.reserve(lamps.size());
    for (const LampDesc& lamp : lamps) names.push_back(lamp.name);
    return names;
}

struct FrameRenderer::Written {
    std::size_t place;
    FinishedImage image;
    RunStats stats;
    OutputGroup outputs;  // what has been written with the image so far
    std::string label;    // empty: the only image
    double seconds = 0;
    struct Line {
        bool is_warning;
        std::string text;
    };
    std::vector<Line> lines{};
    SayCallback keep(bool is_warning) {
        return [this, is_warning](const std::string& line) { lines.push_back({is_warning, line}); };
    }
};

FrameRenderer::FrameRenderer(const RenderArguments& arguments, const std::vector<Frame>& frames,
                             std::vector<std::string> lamps, RunExposure exposure, RunStats stats,
                             Done done)
    : arguments_(arguments),
      frames_(frames),
      lamps_(std::move(lamps)),
      exposure_(std::move(exposure)),
      stats_(std::move(stats)),
      done_(std::move(done)) {}

void FrameRenderer::run(JobScenes& scenes) {
    const StopScope scope(stop_flag());
    const Frame& first = frames_.front();
    engine_.run({scenes, images_of(frames_)}, *this,
                first.camera_name.empty() && !first.variation ? "frame" : "image");
}

void FrameRenderer::say(const std::string& line) const {
    if (!arguments_.quiet) print_message(line + "\n");
}

void FrameRenderer::warn(std::size_t place, const std::string& line) {
    print_message(
        fmt::format("warning: {}{}\n", place == 0 ? "" : place_in_run(frames_[place]), line));
}

void FrameRenderer::tell(Stage stage, double fraction) {
    if (stage != stage_) begin_stage(stage);
    const PathAccuracy& paths = engine_.renderer().report().paths;
    if (progress_) progress_->update(fraction, stage == Stage::render ? describe(paths) : "");
}

void FrameRenderer::begin_stage(Stage stage) {
    stage_ = stage;
    progress_.reset();  // ends the line of the previous stage
    const std::string name(name_of(stage));
    const SequenceClock& clock = engine_.clock();
    const auto show = [&](const char* unit, double scale) {
        progress_ = std::make_unique<Progress>(
            clock.label(measuring_.empty() ? name : measuring_ + ": " + name), unit, scale,
            arguments_.progress, clock.seconds_left());
    };
    if (!measuring_.empty()) {
        show("", 1);
        return;
    }
    const Renderer& renderer = engine_.renderer();
    if (stage == Stage::splat)
        show("lamps", static_cast<double>(renderer.scene().desc().lamps.size()));
    const bool paths = integrator_kind(renderer.scene().desc().render.integrator).traces_paths;
    if (stage == Stage::render && paths)
        show("", 1);  // of how many paths may not be known yet
    else if (stage == Stage::render || stage == Stage::forward_scatter)
        show("Mpx", 1e-6 * static_cast<double>(renderer.report().pixels));
    if (stage == Stage::multiple_scattering || stage == Stage::particles) show("", 1);
    if (stage == Stage::multiple_scattering || stage == Stage::render) begin_orderly_stop();
    if (stage != Stage::forward_scatter) stats_.begin_stage(name);  // which is part of "render"
}

WantedImage FrameRenderer::want(std::size_t place, ImageScene& scene) {
    const Frame& frame = frames_[place];
    if (arguments_.is_aces && scene.desc().render.colour.response == ColourDesc::Response::camera)
        throw UsageError(
            "--aces: R, G and B are in the camera's own colour space, which no matrix turns into "
            "ACES2065-1; leave out render.response or --aces");
    if (!frame.files.preview.empty()) colour_view(scene.desc().render.view);  // throws
    const std::vector<std::string> lamps = names_of(scene.desc().lamps);
    if (lamps != lamps_)
        throw InputError(
            fmt::format("{}its lamps are {}, but those of the first are {}; all images have the "
                        "same lights",
                        place_in_run(frame), fmt::join(lamps, ", "), fmt::join(lamps_, ", ")));
    options_ = {.layers = arguments_.layers,
                .window = frame.window,
                .paths = arguments_.paths(),
                .deep = arguments_.deep.value_or(0)};
    if (!arguments_.numbers.empty()) {
        options_.layers = (options_.layers.empty() ? "default" : options_.layers) + "," +
                          layers_to_measure(scene) + (arguments_.parts.object.empty() ? "" : ",id");
        measured_ = scene;
    }
    stage_.reset();
    return {options_, !frame.files.sensor.empty()};
}

void FrameRenderer::loaded(std::size_t place) {
    Renderer& renderer = engine_.renderer();
    const AssembledScene& scene = renderer.assembled();
    if (place == 0 && !arguments_.quiet)
        for (const VolumeReport& report : scene.volume_reports)
            print_message(describe_grid(report, scene.water.medium));
    engine_.warn_of_image();
    if (!arguments_.parts.object.empty())
        chosen_object(arguments_.parts.object, renderer.scene().desc().geometry,
                      scene.surfaces->names());
    if (frames_[place].files.irradiance_vdb.empty()) return;
    check_irradiance_vdb(scene);
    renderer.splat();
}

void FrameRenderer::count_work(const RenderReport& report) {
    stats_.count("pixels", report.pixels);
    stats_.count("camera_rays", report.camera_rays);
    stats_.count("splat_rays", report.splat_rays);
    stats_.count("light_field_bytes", report.light_bytes);
    stats_.count("active_voxels", report.active_voxels);
    stats_.count("grid_bytes", report.grid_bytes);
    stats_.count("triangles", report.triangles);
    stats_.count("snow_particles", report.snow_particles);
    stats_.count("lamps", report.lamps);
    stats_.count("bands", report.bands);
    if (report.exposure_parts > 0) stats_.count("exposure_parts", report.exposure_parts);
    if (report.colour_groups > 1) stats_.count("colour_groups", report.colour_groups);
    if (report.exposure_parts > 0) stats_.measure("motion_pixels", report.motion_pixels);
    if (report.multiple_error) {
        stats_.measure("multiple_error", *report.multiple_error);
        stats_.measure("multiple_error_of_bands", report.multiple_error_of_bands);
        stats_.measure("multiple_error_of_parts", report.multiple_error_of_parts);
        stats_.measure("multiple_error_of_worst_part", report.multiple_error_of_worst_part);
    }
    if (report.paths.samples == 0) return;
    stats_.count("samples", static_cast<std::uint64_t>(report.paths.samples));
    if (report.paths.error) stats_.measure("error", *report.paths.error);
}

void FrameRenderer::write_irradiance(OutputFile& out) {
    const AssembledScene& scene = engine_.renderer().assembled();
    const SequenceClock& clock = engine_.clock();
    Progress progress(clock.label("irradiance"), "lamps", static_cast<double>(scene.lamps.size()),
                      arguments_.progress, clock.seconds_left());
    write_irradiance_vdb(out, scene, engine_.renderer().light(),
                         [&](double fraction) { progress.update(fraction); });
}

ImageWork FrameRenderer::take(std::size_t place, FinishedImage image) {
    const Frame& frame = frames_[place];
    progress_.reset();
    const RenderReport& report = image.report;
    if (report.paths.samples > 0)
        say(fmt::format("{} of the image's mean", describe(report.paths)));
    if (report.multiple_error)
        say(
            fmt::format("multiple scattering: standard error {:.2g} % of the light in each part of "
                        "the image, {:.2g} % in the worst; {:.2g} % of the image's mean{}",
                        100 * report.multiple_error_of_parts,
                        100 * report.multiple_error_of_worst_part, 100 * *report.multiple_error,
                        describe_bands(report.multiple_error_of_bands,
                                       engine_.renderer().scene().desc().water.bands_nm)));
    if (!report.light_note.empty()) say("note: " + report.light_note);
    count_work(report);
    OutputGroup outputs;
    if (!frame.files.irradiance_vdb.empty()) {
        stats_.begin_stage("irradiance");
        write_irradiance(outputs.add(frame.files.irradiance_vdb));
    }
    stats_.end_stage();
    stats_.set_output(frame.files.main().filename().string(), frame.number);
    if (measured_) {
        const LayerPlan plan = layer_plan(*measured_, arguments_.layers, arguments_.paths());
        stats_.begin_stage("numbers");
        stats_.set_numbers(measure(image));
        stats_.end_stage();
        if (plan.channel_names() != image.film.channel_names())
            image.film = with_channels(image.film, plan.channel_names(), image.film.window());
    }
    const SequenceClock& clock = engine_.clock();
    const SceneDesc& scene = engine_.renderer().scene().desc();
    ImageStorage storage{arguments_.exr(), exposure_.of(image.film), arguments_.preview_bits,
                         colour_view(scene.render.view)};
    if (image.sensor) storage.camera = scene.camera.sensor->image;
    // One that cannot be copied would be no part of a function.
    const auto written = std::make_shared<Written>(
        Written{place, std::move(image), std::exchange(stats_, RunStats()), std::move(outputs),
                clock.is_sequence() ? clock.label("done in ") : ""});
    return {[written, storage, &files = frame.files] {
                const auto begin = std::chrono::steady_clock::now();
                write_images(files, written->image, storage, written->outputs, written->keep(false),
                             written->keep(true));
                const std::chrono::duration<double> elapsed =
                    std::chrono::steady_clock::now() - begin;
                written->seconds = elapsed.count();
            },
            [this, written] { finish(*written); }};
}

std::vector<PartNumbers> FrameRenderer::measure(const FinishedImage& image) {
    const SceneDesc& scene = measured_->desc();
    const std::vector<PicturePart> parts =
        picture_parts(arguments_.parts, scene, image.surfaces->names(), image.film, image.plan);
    std::vector<PartNumbers> numbers = part_numbers({image.film, image.plan}, parts);
    const std::size_t lamps = scene.lamps.size();
    RenderOptions flat = options_;
    flat.deep = 0;
    for (PartNumbers& of_lamp :
         lamp_numbers(engine_.renderer(), *measured_, flat, parts, [&](std::size_t number) {
             stage_.reset();
             measuring_ = number == 0 ? "numbers without lamps"
                                      : fmt::format("numbers of lamp {} of {}", number, lamps);
         }))
        numbers.push_back(std::move(of_lamp));
    measuring_.clear();
    progress_.reset();
    return numbers;
}

void FrameRenderer::finish(Written& written) {
    if (progress_) progress_->end_line();
    for (const auto& [is_warning, text] : written.lines) {
        if (is_warning)
            engine_.warn(written.place, text);
        else
            say(text);
    }
    written.stats.add_stage("write", written.seconds);
    if (!written.label.empty()) {
        const SequenceClock& clock = engine_.clock();
        std::string line = written.label + format_duration(written.stats.total_seconds());
        if (!clock.finished()) line += ", " + format_duration(*clock.seconds_left()) + " left";
        say(line);
    }
    done_(frames_[written.place], std::move(written.stats));
}

}  // namespace uw
