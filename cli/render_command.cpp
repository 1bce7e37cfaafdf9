#include "cli/render_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "camera/image_size.h"
#include "cli/console.h"
#include "cli/grid_summary.h"
#include "cli/irradiance_export.h"
#include "cli/output_files.h"
#include "cli/progress.h"
#include "cli/scene_assembly.h"
#include "cli/scene_rendering.h"
#include "cli/stats.h"
#include "cli/stop_signal.h"
#include "cli/version.h"
#include "core/config_text.h"
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

RenderDesc::Quality quality_named(const std::string& name) {
    if (name == "final") return RenderDesc::Quality::final;
    if (name == "draft") return RenderDesc::Quality::draft;
    throw UsageError(fmt::format("--quality: unknown '{}'; use draft or final", printable(name)));
}

std::string name_of(RenderDesc::Integrator integrator) {
    return std::string(
        std::ranges::find(k_integrator_names, integrator,
                          &std::pair<std::string_view, RenderDesc::Integrator>::second)
            ->first);
}

void apply_arguments(const RenderArguments& a, SceneDesc& desc) {
    if (!a.quality.empty()) desc.render.quality = quality_named(a.quality);
    if (desc.render.quality == RenderDesc::Quality::draft) desc.render.samples = 1;
    if (a.samples) desc.render.samples = *a.samples;
    if (!a.integrator.empty()) desc.render.integrator = integrator_named(a.integrator);
    if (!a.size) return;
    const auto [width, height] = *a.size;
    if (width < 1 || height < 1 || width > 32768 || height > 32768)
        throw UsageError("--size: each side must be 1 to 32768 pixels");
    resize_image(desc.camera, width, height);
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
    const std::string quantity = SensorModel(scene.desc).description();
    const bool draft = scene.desc.render.quality == RenderDesc::Quality::draft;
    const char* const quality = draft ? "draft" : "final";
    ImageMetadata m{{"software", "uwvdb " + program_version()},
                    {"uwvdb/scene", scene.desc.file.filename().string()},
                    {"uwvdb/scene_hash", scene.desc.hash},
                    {"uwvdb/integrator", name_of(scene.desc.render.integrator)},
                    {"uwvdb/quality", std::string(quality)},
                    {"uwvdb/samples", static_cast<double>(scene.desc.render.samples)},
                    {"uwvdb/seed", std::string("none: deterministic")},
                    {"uwvdb/rgb_quantity", quantity},
                    {"uwvdb/units", quantity + ", irradiance and exitance W m^-2, metres"},
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
    if (const auto& port = scene.desc.camera.port) {
        m["uwvdb/port_fresnel"] = std::string(port->fresnel ? "on" : "off");
        m["uwvdb/port_radiance_in"] = std::string(port->radiance_in_air ? "air" : "water");
    }
    if (const auto& lens = scene.desc.camera.lens) {
        m["uwvdb/lens_f_number"] = lens->f_number;
        m["uwvdb/lens_focal_length_m"] = lens->focal_length;
        m["uwvdb/lens_transmission"] = lens->transmission;
    }
    return m;
}

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

void write_irradiance(const std::filesystem::path& file, const AssembledScene& scene,
                      const LightFields& light_fields, bool quiet) {
    Progress progress("irradiance", "lamps", static_cast<double>(scene.lamps.size()), quiet);
    write_irradiance_vdb(file, scene, light_fields, [&](double share) {
        progress.update(share);
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
    // One ray a sample, and one more for the pixel's centre unless that is the sample: its water
    // and ground truth.
    const auto samples = static_cast<std::uint64_t>(scene.desc.render.samples);
    stats.count("camera_rays", pixels * (samples == 1 ? 1 : samples + 1));
    stats.count("splat_rays", splat_rays);
    stats.count("light_field_bytes", splat_bytes);
    stats.count("active_voxels", voxels);
    stats.count("grid_bytes", grid_bytes);
    stats.count("triangles", scene.surfaces->triangle_count());
    stats.count("lamps", scene.lamps.size());
    stats.count("bands", static_cast<std::uint64_t>(scene.water.medium.band_count()));
}

// One line if the image shows nothing, or is empty in part; no black image without a word.
void warn_of_darkness(const Film& film, bool black) {
    const PixelWindow& window = film.window();
    std::size_t empty = 0;
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x) empty += film.pixel(x, y)[k_alpha] == 0 ? 1 : 0;
    const std::size_t pixels =
        static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height());
    if (empty > 0)
        print_message(fmt::format(
            "warning: {} of {} pixels are empty (alpha 0): their rays do not pass the port, "
            "or the lens's distortion has no ray for them\n",
            empty, pixels));
    if (black && empty < pixels)
        print_message(fmt::format(
            "warning: the image is black: no lamp's light reaches the camera; check the "
            "lamps' positions, directions and intensities, the camera's pose, and how far "
            "light comes in this water\n"));
}

// Writes the images; says where they are and what exposure the preview has.
void write_images(const OutputFiles& files, const Film& film, ImageMetadata metadata, bool quiet) {
    const std::optional<double> exposure = automatic_exposure(film);
    const Preview preview = make_preview(film, exposure.value_or(1.0));
    write_exr(files.image, film, metadata);
    metadata["exposure"] = exposure.value_or(1.0);
    write_png(files.preview, preview, metadata);
    warn_of_darkness(film, !exposure);
    if (quiet) return;
    print_message(fmt::format("wrote {}\n", files.image.string()));
    if (exposure)
        print_message(
            fmt::format("wrote {} (preview, R G B x {:.4g})\n", files.preview.string(), *exposure));
    else
        print_message(fmt::format("wrote {} (preview, black)\n", files.preview.string()));
}

}  // namespace

void run_render(const RenderArguments& a) {
    RunStats stats;
    const ThreadLimit limit(a.threads);
    const OutputFiles files = output_files(a);
    const auto say = [&](const std::string& text) {
        if (!a.quiet) print_message(text);
    };

    stats.begin_stage("scene");
    SceneDesc desc = read_scene(a.scene, a.overrides);
    apply_arguments(a, desc);
    const PixelWindow window = window_of(a, desc.camera);
    const std::vector<std::string> lamp_names = names_of(desc.lamps);
    const LayerPlan plan(a.layers, desc.water.bands_nm, lamp_names);
    const BandColour colour(desc.water.bands_nm);
    if (!colour.warning().empty()) desc.warnings.push_back(colour.warning());
    check_output_files(files, desc);
    // Light from beyond a crop is scattered into it: forward scatter needs the whole image.
    const PixelWindow whole{0, 0, desc.camera.width, desc.camera.height};
    const bool uncropped = desc.water.forward_scatter.K > 0 && window != whole;
    if (uncropped)
        desc.warnings.push_back(
            "--crop: forward scatter takes light from the whole image: all of it is rendered, then "
            "cropped; set water.forward_scatter.K=0 to save that time");
    Film film(desc.camera.width, desc.camera.height, uncropped ? whole : window,
              plan.channel_names());

    const AssembledScene scene =
        assemble_scene(desc, [&](const std::string& stage) { stats.begin_stage(stage); });
    for (const VolumeReport& report : scene.volume_reports)
        say(describe_grid(report, scene.water.medium));
    for (const std::string& warning : scene.warnings)
        print_message(fmt::format("warning: {}\n", warning));
    if (!files.irradiance_vdb.empty()) check_irradiance_vdb(scene);

    stats.begin_stage("splat");
    LightFields light_fields;
    const bool volume = desc.render.integrator == RenderDesc::Integrator::volume;
    if (volume || !files.irradiance_vdb.empty()) {
        Progress progress("splat", "lamps", static_cast<double>(scene.lamps.size()), a.quiet);
        light_fields = splat_lamps(scene, light_field_options(desc.render.quality),
                                   [&](double share) { progress.update(share); });
    }

    stats.begin_stage("render");
    begin_orderly_stop();
    render(scene, light_fields, plan, colour, a.quiet, film);
    count_work(scene, light_fields, film, stats);
    if (uncropped) film = cropped(film, window);
    if (!files.irradiance_vdb.empty()) {
        stats.begin_stage("irradiance");
        write_irradiance(files.irradiance_vdb, scene, light_fields, a.quiet);
        say(fmt::format("wrote {}\n", files.irradiance_vdb.string()));
    }
    stats.begin_stage("write");
    write_images(files, film, metadata_of(scene), a.quiet);
    stats.end_stage();
    if (!files.stats.empty())
        stats.write_json(files.stats, a.scene.filename().string(), files.image.filename().string());
    say(fmt::format("done in {}, peak memory {:.0f} MB\n", format_duration(stats.total_seconds()),
                    static_cast<double>(RunStats::peak_memory_bytes()) / 1e6));
}

}  // namespace uw
