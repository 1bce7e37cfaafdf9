#include "cli/render_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "cli/grid_summary.h"
#include "cli/irradiance_export.h"
#include "cli/progress.h"
#include "cli/scene_assembly.h"
#include "cli/scene_rendering.h"
#include "cli/stats.h"
#include "cli/stop_signal.h"
#include "cli/version.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/image_writer.h"
#include "core/parallel.h"
#include "core/scene_reader.h"

namespace uw {

namespace {

RenderDesc::Integrator integrator_named(const std::string& name) {
    for (const auto& [known, integrator] : k_integrator_names)
        if (name == known) return integrator;
    throw UsageError(
        fmt::format("--integrator: unknown '{}'; use volume, planes or reference", name));
}

std::string name_of(RenderDesc::Integrator integrator) {
    return std::string(
        std::ranges::find(k_integrator_names, integrator,
                          &std::pair<std::string_view, RenderDesc::Integrator>::second)
            ->first);
}

void apply_arguments(const RenderArguments& a, SceneDesc& desc) {
    if (a.samples) desc.render.samples = *a.samples;
    if (!a.integrator.empty()) desc.render.integrator = integrator_named(a.integrator);
    if (!a.size) return;
    const auto [width, height] = *a.size;
    if (width < 1 || height < 1 || width > 32768 || height > 32768)
        throw UsageError("--size: each side must be 1 to 32768 pixels");
    CameraDesc& camera = desc.camera;
    const double sx = static_cast<double>(width) / camera.width;
    const double sy = static_cast<double>(height) / camera.height;
    camera.intrinsics = {camera.intrinsics.fx * sx, camera.intrinsics.fy * sy,
                         camera.intrinsics.cx * sx, camera.intrinsics.cy * sy};
    camera.width = width;
    camera.height = height;
}

std::filesystem::path output_of(const RenderArguments& a) {
    if (a.output.empty()) return a.scene.filename().replace_extension(".exr");
    if (a.output.extension() != ".exr")
        throw UsageError(fmt::format("-o {}: the image is OpenEXR; give a name that ends in .exr",
                                     a.output.string()));
    return a.output;
}

std::string band_list(std::span<const double> values) {
    std::string text;
    for (const double value : values)
        text += fmt::format("{}{:g}", text.empty() ? "" : ", ", value);
    return text;
}

ImageMetadata metadata_of(const AssembledScene& scene) {
    const Medium& medium = scene.water.medium;
    std::vector<double> a, b, c;
    for (int band = 0; band < medium.band_count(); ++band) {
        a.push_back(medium.uniform.absorption[static_cast<std::size_t>(band)]);
        c.push_back(medium.uniform.attenuation(band));
        b.push_back(c.back() - a.back());
    }
    std::string phases;
    for (const auto& phase : medium.phase_functions)
        phases += (phases.empty() ? "" : "; ") + phase->description();
    ImageMetadata m{
        {"software", "uwvdb " + program_version()},
        {"uwvdb/scene", scene.desc.file.filename().string()},
        {"uwvdb/scene_hash", scene.desc.hash},
        {"uwvdb/integrator", name_of(scene.desc.render.integrator)},
        {"uwvdb/samples", static_cast<double>(scene.desc.render.samples)},
        {"uwvdb/seed", std::string("none: deterministic")},
        {"uwvdb/units", std::string("radiance W m^-2 sr^-1, irradiance W m^-2, metres")},
        {"uwvdb/bands_nm", band_list(medium.wavelengths_nm)},
        {"uwvdb/water_absorption_per_m", band_list(a)},
        {"uwvdb/water_scattering_per_m", band_list(b)},
        {"uwvdb/water_attenuation_per_m", band_list(c)},
        {"uwvdb/phase_functions", phases}};
    if (const ForwardScatterDesc& forward = scene.desc.water.forward_scatter; forward.K > 0) {
        m["uwvdb/forward_scatter_K"] = forward.K;
        m["uwvdb/forward_scatter_G_per_m"] = forward.G;
        m["uwvdb/forward_scatter_B_rad_per_m"] = forward.B;
        m["uwvdb/forward_scatter_shape"] = std::string(
            forward.shape == ForwardScatterDesc::Shape::gaussian ? "gaussian" : "exponential");
    }
    m["uwvdb/slab_near_m"] = scene.slabs.near;
    m["uwvdb/slab_thickness_m"] = scene.slabs.thickness();
    m["uwvdb/slabs"] = static_cast<double>(scene.slabs.count);
    if (const auto& lens = scene.desc.camera.lens) {
        m["uwvdb/lens_f_number"] = lens->f_number;
        m["uwvdb/lens_focal_length_m"] = lens->focal_length;
        m["uwvdb/lens_transmission"] = lens->transmission;
    }
    return m;
}

std::vector<std::string> names_of(const std::vector<LampDesc>& lamps) {
    std::vector<std::string> names;
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

void render(const AssembledScene& scene, const LightFields& light_fields, const LayerPlan& plan,
            const BandColour& colour, bool quiet, Film& film) {
    const auto integrator = make_integrator(scene, light_fields);
    const double megapixels = 1e-6 * film.window().width() * film.window().height();
    std::unique_ptr<Progress> progress;
    std::string pass;
    std::mutex mutex;
    render_scene(scene, light_fields, *integrator, plan, colour, film,
                 [&](const std::string& name, double fraction) {
                     const std::lock_guard lock(mutex);
                     if (name != pass) {
                         progress.reset();  // ends the line of the pass before
                         progress = std::make_unique<Progress>(name, "Mpx", megapixels, quiet);
                         pass = name;
                     }
                     progress->update(fraction);
                     return !stop_requested();
                 });
}

void count_work(const AssembledScene& scene, const LightFields& light_fields, const Film& film,
                RunStats& stats) {
    const auto pixels = static_cast<std::uint64_t>(film.window().width()) *
                        static_cast<std::uint64_t>(film.window().height());
    std::uint64_t splat_rays = 0, splat_bytes = 0, voxels = 0, grid_bytes = 0;
    for (const auto& field : light_fields) {
        splat_rays += field->rays_traced();
        splat_bytes += field->bytes();
    }
    for (const VolumeReport& report : scene.volume_reports) {
        voxels += static_cast<std::uint64_t>(report.statistics.active_voxels);
        grid_bytes += report.bytes;
    }
    stats.count("pixels", pixels);
    // One ray a sample, and one more for the pixel's centre: its water and ground truth.
    stats.count("camera_rays",
                pixels * (static_cast<std::uint64_t>(scene.desc.render.samples) + 1));
    stats.count("splat_rays", splat_rays);
    stats.count("light_field_bytes", splat_bytes);
    stats.count("active_voxels", voxels);
    stats.count("grid_bytes", grid_bytes);
    stats.count("triangles", scene.surfaces->triangle_count());
    stats.count("lamps", scene.lamps.size());
    stats.count("bands", static_cast<std::uint64_t>(scene.water.medium.band_count()));
}

// Writes the images; says where they are and what exposure the preview has.
void write_images(const std::filesystem::path& output, const Film& film, ImageMetadata metadata,
                  bool quiet) {
    write_exr(output, film, metadata);
    std::filesystem::path preview = output;
    preview.replace_extension(".png");
    const std::optional<double> exposure = automatic_exposure(film);
    metadata["exposure"] = exposure.value_or(1.0);
    write_png(preview, make_preview(film, exposure.value_or(1.0)), metadata);
    if (!exposure)
        fmt::print(stderr,
                   "warning: the image is black: no lamp's light reaches the camera; check the "
                   "lamps' positions, directions and intensities, and the camera's pose\n");
    if (quiet) return;
    fmt::print(stderr, "wrote {}\n", output.string());
    if (exposure)
        fmt::print(stderr, "wrote {} (preview, radiance x {:.4g})\n", preview.string(), *exposure);
    else
        fmt::print(stderr, "wrote {} (preview, black)\n", preview.string());
}

}  // namespace

void run_render(const RenderArguments& a) {
    RunStats stats;
    const ThreadLimit limit(a.threads);
    const std::filesystem::path output = output_of(a);
    const auto say = [&](const std::string& text) {
        if (!a.quiet) fmt::print(stderr, "{}", text);
    };

    stats.begin_stage("scene");
    SceneDesc desc = read_scene(a.scene, a.overrides);
    apply_arguments(a, desc);
    const PixelWindow window = window_of(a, desc.camera);
    const std::vector<std::string> lamp_names = names_of(desc.lamps);
    const LayerPlan plan(a.layers, desc.water.bands_nm, lamp_names);
    const BandColour colour(desc.water.bands_nm);
    if (!colour.warning().empty()) desc.warnings.push_back(colour.warning());
    // Found out now rather than after an hour: can the results be written?
    for (const std::filesystem::path& file : {output, a.stats, a.irradiance_vdb})
        if (!file.empty()) const AtomicFile probe(file);

    const AssembledScene scene =
        assemble_scene(desc, [&](const std::string& stage) { stats.begin_stage(stage); });
    for (const VolumeReport& report : scene.volume_reports)
        say(describe_grid(report, scene.water.medium));
    for (const std::string& warning : scene.warnings) fmt::print(stderr, "warning: {}\n", warning);
    if (stop_requested()) throw Interrupted();

    stats.begin_stage("splat");
    LightFields light_fields;
    const bool volume = desc.render.integrator == RenderDesc::Integrator::volume;
    if (volume || !a.irradiance_vdb.empty()) light_fields = splat_lamps(scene, LightFieldOptions{});
    if (stop_requested()) throw Interrupted();

    stats.begin_stage("render");
    // Light from beyond a crop is scattered into it: forward scatter needs the whole image.
    const PixelWindow whole{0, 0, desc.camera.width, desc.camera.height};
    const bool uncropped = desc.water.forward_scatter.K > 0 && window != whole;
    if (uncropped)
        fmt::print(stderr,
                   "warning: --crop: forward scatter takes light from the whole image: all of it "
                   "is rendered, then cropped; set water.forward_scatter.K=0 to save that time\n");
    Film film(desc.camera.width, desc.camera.height, uncropped ? whole : window,
              plan.channel_names());
    render(scene, light_fields, plan, colour, a.quiet, film);
    count_work(scene, light_fields, film, stats);
    if (uncropped) film = cropped(film, window);

    stats.begin_stage("write");
    write_images(output, film, metadata_of(scene), a.quiet);
    if (!a.irradiance_vdb.empty()) {
        stats.begin_stage("irradiance");
        write_irradiance_vdb(a.irradiance_vdb, scene, light_fields);
        say(fmt::format("wrote {}\n", a.irradiance_vdb.string()));
    }
    stats.end_stage();
    if (!a.stats.empty())
        stats.write_json(a.stats, a.scene.filename().string(), output.filename().string());
    say(fmt::format("done in {}, peak memory {:.0f} MB\n", format_duration(stats.total_seconds()),
                    static_cast<double>(RunStats::peak_memory_bytes()) / 1e6));
}

}  // namespace uw
