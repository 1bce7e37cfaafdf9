#include "cli/render/frame_renderer.h"

#include <fmt/format.h>

#include <memory>
#include <mutex>
#include <utility>

#include "cli/console.h"
#include "cli/grid_summary.h"
#include "cli/progress.h"
#include "cli/render/image_output.h"
#include "cli/render/irradiance_export.h"
#include "cli/stop_signal.h"
#include "core/base/error.h"
#include "core/integrators/integrator_table.h"

namespace uw {

namespace {

// Light from beyond a crop is scattered into it: forward scatter needs the whole image.
PixelWindow rendered_window(const SceneDesc& desc, const PixelWindow& written) {
    if (desc.water.forward_scatter.K == 0) return written;
    return {0, 0, desc.camera.width, desc.camera.height};
}

void count_work(const AssembledScene& scene, const DeepShadows& deep_shadows,
                const SplatCounts& splat, const Film& film, RunStats& stats) {
    const auto pixels = static_cast<std::uint64_t>(film.window().width()) *
                        static_cast<std::uint64_t>(film.window().height());
    std::uint64_t splat_bytes = 0, voxels = 0, grid_bytes = 0;
    for (const auto& field : deep_shadows) splat_bytes += field->bytes();
    for (const VolumeReport& report : scene.volume_reports) {
        voxels += static_cast<std::uint64_t>(report.statistics.active_voxels);
        grid_bytes += report.bytes;
    }
    stats.count("pixels", pixels);
    // One ray a sample, and one more for the pixel's centre unless that is the sample: its water
    // and ground truth.
    const auto samples = static_cast<std::uint64_t>(scene.desc.render.samples);
    stats.count("camera_rays", pixels * (samples == 1 ? 1 : samples + 1));
    stats.count("splat_rays", splat.rays);
    stats.count("light_field_bytes", splat_bytes);
    stats.count("active_voxels", voxels);
    stats.count("grid_bytes", grid_bytes);
    stats.count("triangles", scene.surfaces->triangle_count());
    stats.count("lamps", scene.lamps.size());
    stats.count("bands", static_cast<std::uint64_t>(scene.water.medium.band_count()));
}

// What `warning` says of any frame: with the sequences' names in place of their files'.
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

void stop_if_requested() {
    if (stop_requested()) throw Interrupted();
}

}  // namespace

FrameRenderer::FrameRenderer(const RenderArguments& arguments, const SceneDesc& desc,
                             ImagePlan plan, std::size_t count)
    : arguments_(arguments),
      all_frames_(desc),
      plan_(std::move(plan)),
      film_(1, 1, {0, 0, 1, 1}, plan_.layers.channel_names()),
      clock_(count, desc.cameras.empty() ? "frame" : "image") {}

// The cameras of a rig may differ in size; before the first image the film has none.
void FrameRenderer::fit_film(const Frame& frame, const CameraDesc& camera) {
    SceneDesc desc = all_frames_;
    desc.camera = camera;
    const PixelWindow rendered = rendered_window(desc, window(frame));
    if (film_.width() == camera.width && film_.height() == camera.height &&
        film_.window() == rendered)
        return;
    film_ = Film(1, 1, {0, 0, 1, 1}, plan_.layers.channel_names());  // frees the memory
    film_ = Film(camera.width, camera.height, rendered, plan_.layers.channel_names());
}

void FrameRenderer::say(const std::string& line) const {
    if (!arguments_.quiet) print_message(line + "\n");
}

void FrameRenderer::warn(const Frame& frame, const std::string& line) {
    if (!warned_.insert(without_frame(line, scene_.desc, all_frames_)).second) return;
    std::string which;
    if (clock_.images_done() > 0 && frame.number) which = fmt::format("frame {}: ", *frame.number);
    if (clock_.images_done() > 0 && !frame.camera_name.empty())
        which += fmt::format("camera {}: ", frame.camera_name);
    print_message(fmt::format("warning: {}{}\n", which, line));
}

void FrameRenderer::assemble(const Frame& frame, const SceneDesc& desc, RunStats& stats) {
    const auto begin_stage = [&](const std::string& stage) {
        stop_if_requested();
        stats.begin_stage(stage);
    };
    scene_ = assemble_scene(desc, begin_stage, std::move(scene_));
    if (clock_.images_done() == 0 && !arguments_.quiet)
        for (const VolumeReport& report : scene_.volume_reports)
            print_message(describe_grid(report, scene_.water.medium));
    for (const std::string& warning : scene_.warnings) warn(frame, warning);
    if (!frame.files.irradiance_vdb.empty()) check_irradiance_vdb(scene_);
}

DeepShadows FrameRenderer::splat(bool with_irradiance) {
    const IntegratorKind& integrator = integrator_kind(scene_.desc.render.integrator);
    if (!integrator.needs_deep_shadows && !with_irradiance) return {};
    Progress progress(clock_.label("splat"), "lamps", static_cast<double>(scene_.lamps.size()),
                      arguments_.quiet, clock_.seconds_left());
    return splatter_.splat(scene_, deep_shadow_options(scene_.desc.render.quality),
                           [&](double share) {
                               stop_if_requested();
                               progress.update(share);
                           });
}

void FrameRenderer::render_image(const DeepShadows& deep_shadows) {
    const LightTransport transport = make_light_transport(scene_, deep_shadows);
    const double megapixels = 1e-6 * film_.window().width() * film_.window().height();
    std::unique_ptr<Progress> progress;
    std::string pass;
    std::mutex mutex;
    film_.clear();
    render_scene(scene_, deep_shadows, transport, plan_.layers, plan_.colour, film_,
                 [&](const std::string& name, double fraction) {
                     const std::lock_guard lock(mutex);
                     if (name != pass) {
                         progress.reset();  // ends the line of the pass before
                         progress =
                             std::make_unique<Progress>(clock_.label(name), "Mpx", megapixels,
                                                        arguments_.quiet, clock_.seconds_left());
                         pass = name;
                     }
                     progress->update(fraction);
                     return !stop_requested();
                 });
}

void FrameRenderer::write_irradiance(const std::filesystem::path& file,
                                     const DeepShadows& deep_shadows) {
    Progress progress(clock_.label("irradiance"), "lamps", static_cast<double>(scene_.lamps.size()),
                      arguments_.quiet, clock_.seconds_left());
    write_irradiance_vdb(file, scene_, deep_shadows, [&](double share) {
        progress.update(share);
        return !stop_requested();
    });
}

void FrameRenderer::write_image(const Frame& frame) {
    const auto write = [&](const Film& film) {
        write_images(
            frame.files, film, metadata_of(scene_, frame.number),
            [&](const std::string& line) { say(line); },
            [&](const std::string& line) { warn(frame, line); });
    };
    if (film_.window() == window(frame))
        write(film_);
    else
        write(cropped(film_, window(frame)));
}

void FrameRenderer::render(const Frame& frame, const SceneDesc& desc, RunStats& stats) {
    const OutputFiles& files = frame.files;
    fit_film(frame, desc.camera);
    assemble(frame, desc, stats);
    stats.begin_stage("splat");
    const DeepShadows deep_shadows = splat(!files.irradiance_vdb.empty());
    stats.begin_stage("render");
    begin_orderly_stop();
    render_image(deep_shadows);
    count_work(scene_, deep_shadows, splatter_.counts(), film_, stats);
    if (!files.irradiance_vdb.empty()) {
        stats.begin_stage("irradiance");
        write_irradiance(files.irradiance_vdb, deep_shadows);
        say(fmt::format("wrote {}", files.irradiance_vdb.string()));
    }
    stats.begin_stage("write");
    write_image(frame);
    stats.end_stage();
    stats.set_output(files.image.filename().string(), frame.number);
    if (!clock_.is_sequence()) return;
    std::string line = clock_.label("done in " + format_duration(stats.total_seconds()));
    clock_.finish_image();
    if (!clock_.finished()) line += ", " + format_duration(*clock_.seconds_left()) + " left";
    say(line);
}

}  // namespace uw
