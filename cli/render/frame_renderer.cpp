#include "cli/render/frame_renderer.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "cli/console.h"
#include "cli/grid_summary.h"
#include "cli/process.h"
#include "cli/render/image_output.h"
#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/image/pixel_image.h"
#include "core/light/integrator_table.h"
#include "render/image_header.h"

namespace uw {

namespace {

// What `warning` says about any frame: with the names of the sequences instead of their files.
std::string without_frame(std::string warning, const SceneDesc& frame, const SceneDesc& all) {
    const auto replace = [&](const auto& of_frame, const auto& of_all) {
        const std::string file = of_frame.file.string();
        const std::size_t at = warning.find(file);
        if (of_all.is_sequence && at != std::string::npos)
            warning.replace(at, file.size(), of_all.file.string());
    };
    for (std::size_t v = 0; v < frame.volumes.size(); ++v)
        replace(frame.volumes[v], all.volumes[v]);
    for (std::size_t g = 0; g < frame.geometry.size(); ++g)
        replace(frame.geometry[g], all.geometry[g]);
    return warning;
}

// "64 samples, error 1.83 %"; empty if no light paths have been traced.
std::string describe(const PathAccuracy& reached) {
    if (reached.samples == 0) return {};
    std::string text = fmt::format("{} samples", reached.samples);
    if (reached.error) text += fmt::format(", error {:.3g} %", 100 * *reached.error);
    return text;
}

}  // namespace

struct FrameRenderer::Written {
    Frame frame;
    bool is_first;
    Film film;
    std::optional<SensorImage> sensor;
    std::shared_ptr<const Surfaces> surfaces;
    ImageMetadata metadata;
    RunStats stats;
    OutputGroup outputs;
    std::string label;  // empty: the only image
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

FrameRenderer::FrameRenderer(const RenderArguments& arguments, std::size_t count, std::string noun,
                             Done done)
    : arguments_(arguments),
      clock_(count, std::move(noun)),
      renderer_(
          [this](const std::string& stage, double fraction) { return proceed(stage, fraction); }),
      done_(std::move(done)) {}

FrameRenderer::~FrameRenderer() = default;

void FrameRenderer::say(const std::string& line) const {
    if (!arguments_.quiet) print_message(line + "\n");
}

void FrameRenderer::warn(const Frame& frame, bool is_first, const std::string& line) {
    const ImageScene& scene = renderer_.scene();
    if (!warned_.insert(without_frame(line, scene.desc(), scene.whole())).second) return;
    const std::string which = is_first ? "" : place_in_run(frame);
    print_message(fmt::format("warning: {}{}\n", which, line));
}

bool FrameRenderer::proceed(const std::string& stage, double fraction) {
    const std::lock_guard lock(mutex_);
    if (stage != stage_) begin_stage(stage);
    if (writing_ && writing_->is_done()) {
        if (progress_) progress_->end_line();
        finish();
    }
    const PathAccuracy& paths = renderer_.report().paths;
    if (progress_) progress_->update(fraction, stage == "render" ? describe(paths) : "");
    return !stop_requested();
}

void FrameRenderer::begin_stage(const std::string& stage) {
    stage_ = stage;
    progress_.reset();  // ends the line of the previous stage
    if (!measuring_.empty()) {
        progress_ = std::make_unique<Progress>(clock_.label(measuring_ + ": " + stage), "", 1,
                                               arguments_.quiet, clock_.seconds_left());
        return;
    }
    const auto show = [&](const char* unit, double scale) {
        progress_ = std::make_unique<Progress>(clock_.label(stage), unit, scale, arguments_.quiet,
                                               clock_.seconds_left());
    };
    if (stage == "splat") show("lamps", static_cast<double>(renderer_.scene().desc().lamps.size()));
    const bool paths = integrator_kind(renderer_.scene().desc().render.integrator).traces_paths;
    if (stage == "render" && paths)
        show("", 1);  // of how many paths may not be known yet
    else if (stage == "render" || stage == "forward scatter")
        show("Mpx", 1e-6 * static_cast<double>(renderer_.report().pixels));
    if (stage == "multiple scattering") show("", 1);
    if (stage == "multiple scattering" || stage == "render") begin_orderly_stop();
    if (stage != "forward scatter") stats_->begin_stage(stage);  // which is part of "render"
}

void FrameRenderer::prepare(const Frame& frame, const RenderOptions& options) {
    renderer_.prepare(options);
    const AssembledScene& scene = renderer_.assembled();
    if (is_first() && !arguments_.quiet)
        for (const VolumeReport& report : scene.volume_reports)
            print_message(describe_grid(report, scene.water.medium));
    for (const std::string& warning : renderer_.report().warnings) warn(frame, is_first(), warning);
}

void FrameRenderer::count_work(RunStats& stats) const {
    const RenderReport& report = renderer_.report();
    stats.count("pixels", report.pixels);
    stats.count("camera_rays", report.camera_rays);
    stats.count("splat_rays", report.splat_rays);
    stats.count("light_field_bytes", report.light_bytes);
    stats.count("active_voxels", report.active_voxels);
    stats.count("grid_bytes", report.grid_bytes);
    stats.count("triangles", report.triangles);
    stats.count("snow_particles", report.snow_particles);
    stats.count("lamps", report.lamps);
    stats.count("bands", report.bands);
    if (report.exposure_parts > 0) stats.count("exposure_parts", report.exposure_parts);
    if (report.exposure_parts > 0) stats.measure("motion_pixels", report.motion_pixels);
    if (report.multiple_error) stats.measure("multiple_error", *report.multiple_error);
    if (report.paths.samples == 0) return;
    stats.count("samples", static_cast<std::uint64_t>(report.paths.samples));
    if (report.paths.error) stats.measure("error", *report.paths.error);
}

void FrameRenderer::write_irradiance(OutputFile& out) {
    const AssembledScene& scene = renderer_.assembled();
    Progress progress(clock_.label("irradiance"), "lamps", static_cast<double>(scene.lamps.size()),
                      arguments_.quiet, clock_.seconds_left());
    write_irradiance_vdb(out, scene, renderer_.light(), [&](double share) {
        progress.update(share);
        return !stop_requested();
    });
}

void FrameRenderer::render(const Frame& frame, ImageScene scene, RunStats stats) {
    const StopScope scope(stop_flag());
    const OutputFiles& files = frame.files;
    const bool with_irradiance = !files.irradiance_vdb.empty();
    RenderOptions options{
        .layers = arguments_.layers, .window = frame.window, .paths = arguments_.paths()};
    if (!arguments_.numbers.empty())
        options.layers = (options.layers.empty() ? "default" : options.layers) + "," +
                         layers_to_measure(scene.desc()) +
                         (arguments_.parts.object.empty() ? "" : ",id");
    const SensorImager imager(frame, scene.desc(), options);
    std::optional<ImageScene> measured;
    if (!arguments_.numbers.empty()) measured = scene;
    stats_ = &stats;
    stage_.clear();
    renderer_.set_scene(std::move(scene));
    prepare(frame, imager.rendered());
    if (!arguments_.parts.object.empty())
        chosen_object(arguments_.parts.object, renderer_.scene().desc().geometry,
                      renderer_.assembled().surfaces->names());
    if (with_irradiance) {
        check_irradiance_vdb(renderer_.assembled());
        renderer_.splat();
    }
    const std::size_t warned = renderer_.report().warnings.size();
    renderer_.render(imager.rendered());
    progress_.reset();
    const RenderReport& report = renderer_.report();
    for (std::size_t i = warned; i < report.warnings.size(); ++i)
        warn(frame, is_first(), report.warnings[i]);
    if (report.paths.samples > 0)
        say(fmt::format("{} of the image's mean", describe(report.paths)));
    if (report.multiple_error)
        say(fmt::format("multiple scattering: standard error {:.2g} % of the image's mean",
                        100 * *report.multiple_error));
    count_work(stats);
    OutputGroup outputs;
    if (with_irradiance) {
        stats.begin_stage("irradiance");
        write_irradiance(outputs.add(files.irradiance_vdb));
    }
    stats.end_stage();
    stats.set_output(files.main().filename().string(), frame.number);
    ImageMetadata metadata =
        metadata_of(renderer_.assembled(), frame.number, options.paths, report);
    Film film = renderer_.release_film();
    std::optional<SensorImage> sensor =
        imager.take(film, layer_plan(renderer_.scene(), options.layers, options.paths));
    if (!arguments_.numbers.empty()) {
        const LayerPlan written =
            layer_plan(renderer_.scene(), arguments_.layers, arguments_.paths());
        stats.begin_stage("numbers");
        stats.set_numbers(measure(*measured, film, options));
        stats.end_stage();
        if (written.channel_names() != film.channel_names())
            film = with_channels(film, written.channel_names(), film.window());
    }
    begin_writing(frame, std::move(film), std::move(sensor), std::move(metadata), std::move(stats),
                  std::move(outputs));
}

std::vector<PartNumbers> FrameRenderer::measure(const ImageScene& scene, const Film& film,
                                                const RenderOptions& options) {
    const LayerPlan plan = layer_plan(scene, options.layers, options.paths);
    const std::vector<PicturePart> parts = picture_parts(
        arguments_.parts, scene.desc(), renderer_.assembled().surfaces->names(), film, plan);
    std::vector<PartNumbers> numbers = part_numbers({film, plan}, parts);
    const std::size_t lamps = scene.desc().lamps.size();
    for (PartNumbers& of_lamp :
         lamp_numbers(renderer_, scene, options, parts, [&](std::size_t image) {
             stage_.clear();
             measuring_ = image == 0 ? "numbers without lamps"
                                     : fmt::format("numbers of lamp {} of {}", image, lamps);
         }))
        numbers.push_back(std::move(of_lamp));
    measuring_.clear();
    progress_.reset();
    return numbers;
}

std::optional<double> FrameRenderer::exposure_of(const Film& film) {
    using Kind = PreviewExposure::Kind;
    const PreviewExposure& wanted = arguments_.exposure;
    if (wanted.kind == Kind::automatic) return std::nullopt;
    if (wanted.kind == Kind::fixed) return wanted.factor;
    // A black image has none of its own. Rounded as its file states it, so that a run that
    // continues a sequence uses the same.
    if (const auto own = automatic_exposure(film); own && !first_exposure_)
        first_exposure_ = as_stated_in_png(*own);
    return first_exposure_;
}

void FrameRenderer::begin_writing(const Frame& frame, Film film, std::optional<SensorImage> sensor,
                                  ImageMetadata metadata, RunStats stats, OutputGroup outputs) {
    finish();
    std::string label = clock_.is_sequence() ? clock_.label("done in ") : "";
    written_.reset(new Written{frame, is_first(), std::move(film), std::move(sensor),
                               renderer_.assembled().surfaces, std::move(metadata),
                               std::move(stats), std::move(outputs), std::move(label)});
    clock_.finish_image();
    const ImageStorage storage{arguments_.exr(), exposure_of(written_->film),
                               arguments_.is_preview_16_bit};
    writing_ = std::make_unique<BackgroundTask>([&written = *written_, storage] {
        const auto begin = std::chrono::steady_clock::now();
        write_images(written.frame.files, written.film, written.sensor, written.surfaces->names(),
                     std::move(written.metadata), storage, written.outputs, written.keep(false),
                     written.keep(true));
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
        written.seconds = elapsed.count();
    });
    // The next image needs as much memory again, and some to work with.
    if (2 * written_->film.values().size_bytes() > available_memory_bytes()) finish();
}

void FrameRenderer::finish() {
    if (!writing_) return;
    const std::unique_ptr<Written> written = std::move(written_);
    const std::unique_ptr<BackgroundTask> writing = std::move(writing_);
    writing->finish();
    for (const auto& [is_warning, text] : written->lines) {
        if (is_warning)
            warn(written->frame, written->is_first, text);
        else
            say(text);
    }
    written->stats.add_stage("write", written->seconds);
    if (!written->label.empty()) {
        std::string line = written->label + format_duration(written->stats.total_seconds());
        if (!clock_.finished()) line += ", " + format_duration(*clock_.seconds_left()) + " left";
        say(line);
    }
    done_(written->frame, std::move(written->stats));
}

}  // namespace uw
