#include "cli/render/image_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <vector>

#include "cli/version.h"
#include "cli/word_of.h"
#include "core/image/preview.h"
#include "core/integrators/integrator_table.h"
#include "core/integrators/sensor.h"
#include "render/id_table.h"

namespace uw {

namespace {

std::string band_list(std::span<const double> values) {
    std::string text;
    for (const double value : values)
        text += fmt::format("{}{:g}", text.empty() ? "" : ", ", value);
    return text;
}

// The first three rows of the 4 x 4 matrix, the last being 0 0 0 1.
std::string matrix_rows(const Affine& pose) {
    std::string text;
    for (int row = 0; row < 3; ++row)
        text += fmt::format("{}{:.17g} {:.17g} {:.17g} {:.17g}", text.empty() ? "" : "; ",
                            pose.linear()[0][row], pose.linear()[1][row], pose.linear()[2][row],
                            pose.offset()[row]);
    return text;
}

// A warning of one line if the image is black, or empty in part.
void warn_of_darkness(const Film& film, bool black, const SayCallback& warn) {
    const PixelWindow& window = film.window();
    std::size_t empty = 0;
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x) empty += film.pixel(x, y)[k_alpha] == 0 ? 1 : 0;
    const std::size_t pixels =
        static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height());
    if (empty > 0)
        warn(
            fmt::format("{} of {} pixels are empty (alpha 0): their rays do not pass through the "
                        "port, or the lens's distortion leaves no ray for them",
                        empty, pixels));
    if (black && empty < pixels)
        warn(
            "the image is black: no lamp's light reaches the camera; check the "
            "lamps' positions, directions and intensities, the camera's pose, and how far "
            "light travels in this water");
}

void warn_of_half(const Film& film, const SayCallback& warn) {
    const HalfLoss loss = half_loss(film);
    if (loss.too_large > 0)
        warn(fmt::format(
            "--precision half: {} values are too large for half floats, and infinite in "
            "the file; use --precision float",
            loss.too_large));
    if (loss.too_dark)
        warn(
            "--precision half: the light is so weak that half floats round it visibly; use "
            "--precision float");
}

void write_preview(const std::filesystem::path& file, const Film& film, const ImageStorage& storage,
                   double exposure, const ImageMetadata& metadata) {
    if (storage.is_preview_16_bit)
        write_png(file, make_preview16(film, exposure), metadata);
    else
        write_png(file, make_preview(film, exposure), metadata);
}

void describe(const SensorDesc& sensor, ImageMetadata& m) {
    m["uwvdb/sensor_exposure_s"] = *sensor.exposure;
    m["uwvdb/sensor_mosaic"] = word_of(sensor.mosaic, k_sensor_mosaics);
    m["uwvdb/sensor_gain_dn_per_e"] = sensor.system_gain();
    m["uwvdb/sensor_black_level_dn"] = sensor.black_level;
    m["uwvdb/sensor_bit_depth"] = static_cast<double>(sensor.bit_depth);
    m["uwvdb/sensor_seed"] = static_cast<double>(sensor.seed);
}

}  // namespace

ImageMetadata metadata_of(const SceneDesc& scene, std::optional<int> frame,
                          const PathRequest& paths) {
    const std::string quantity = SensorModel(scene).description();
    ImageMetadata m{{"software", "uwvdb " + program_version()},
                    {"uwvdb/scene", scene.file.filename().string()},
                    {"uwvdb/scene_hash", scene.hash},
                    {"uwvdb/integrator", word_of(scene.render.integrator, k_integrator_names)},
                    {"uwvdb/quality", word_of(scene.render.quality, k_quality_names)},
                    {"uwvdb/samples", static_cast<double>(samples_of(scene.render))},
                    {"uwvdb/seed", std::string("none: deterministic")},
                    {"uwvdb/rgb_quantity", quantity},
                    {"uwvdb/units", quantity + ", irradiance and exitance W m^-2, metres"},
                    {"uwvdb/bands_nm", band_list(scene.water.bands_nm)}};
    if (const auto scattering = scattering_of(scene.render);
        scattering == RenderDesc::Scattering::multiple)
        m["uwvdb/scattering"] = word_of(scattering, k_scattering_names);
    if (integrator_kind(scene.render.integrator).traces_paths)
        m["uwvdb/seed"] = std::string("0: the same paths every time");
    if (paths.error) {
        m.erase("uwvdb/samples");  // follows from the error
        m["uwvdb/error_requested"] = *paths.error;
    }
    if (frame) m["uwvdb/frame"] = fmt::format("{}", *frame);
    if (scene.time) m["uwvdb/time_s"] = *scene.time;
    if (scene.render.shutter > 0) m["uwvdb/shutter_s"] = scene.render.shutter;
    if (scene.camera.line_time > 0) m["uwvdb/line_time_s"] = scene.camera.line_time;
    if (!scene.camera_name.empty()) m["uwvdb/camera"] = scene.camera_name;
    const IntrinsicsDesc& k = scene.camera.intrinsics;
    m["uwvdb/intrinsics_fx_fy_cx_cy_px"] =
        fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}", k.fx, k.fy, k.cx, k.cy);
    m["uwvdb/world_from_camera"] = matrix_rows(scene.camera.world_from_camera);
    if (scene.render.colour.response == ColourDesc::Response::camera)
        m["uwvdb/rgb_response"] = scene.render.colour.file.filename().string();
    if (const ForwardScatterDesc& forward = scene.water.forward_scatter; forward.K > 0) {
        m["uwvdb/forward_scatter_K"] = forward.K;
        m["uwvdb/forward_scatter_G_per_m"] = forward.G;
        m["uwvdb/forward_scatter_B_rad_per_m"] = forward.B;
        m["uwvdb/forward_scatter_shape"] = std::string(
            forward.shape == ForwardScatterDesc::Shape::gaussian ? "gaussian" : "exponential");
    }
    const auto note_port = [&m](const auto& port) {
        m["uwvdb/port_fresnel"] = std::string(port.fresnel ? "on" : "off");
        m["uwvdb/port_radiance_in"] = std::string(port.radiance_in_air ? "air" : "water");
    };
    if (scene.camera.port) std::visit(note_port, *scene.camera.port);
    if (const auto& lens = scene.camera.lens) {
        m["uwvdb/lens_f_number"] = lens->f_number;
        m["uwvdb/lens_focal_length_m"] = lens->focal_length;
        m["uwvdb/lens_transmission"] = lens->transmission;
    }
    if (scene.camera.sensor) describe(*scene.camera.sensor, m);
    return m;
}

ImageMetadata metadata_of(const AssembledScene& scene, std::optional<int> frame,
                          const PathRequest& paths, const RenderReport& report) {
    ImageMetadata m = metadata_of(scene.desc, frame, paths);
    if (report.paths.samples > 0) m["uwvdb/samples"] = static_cast<double>(report.paths.samples);
    if (report.paths.error) m["uwvdb/error"] = *report.paths.error;
    if (report.multiple_error) m["uwvdb/multiple_error"] = *report.multiple_error;
    if (report.exposure_parts > 0) {
        m["uwvdb/exposure_parts"] = static_cast<double>(report.exposure_parts);
        m["uwvdb/exposure_samples"] = static_cast<double>(report.exposure_samples);
    }
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
    m["uwvdb/water_absorption_per_m"] = band_list(a);
    m["uwvdb/water_scattering_per_m"] = band_list(b);
    m["uwvdb/water_attenuation_per_m"] = band_list(c);
    m["uwvdb/phase_functions"] = phases;
    m["uwvdb/slab_near_m"] = scene.slabs.near;
    m["uwvdb/slab_thickness_m"] = scene.slabs.thickness();
    m["uwvdb/slabs"] = static_cast<double>(scene.slabs.count);
    return m;
}

void write_images(const OutputFiles& files, const Film& film,
                  const std::optional<SensorImage>& sensor, const SurfaceNames& names,
                  ImageMetadata metadata, const ImageStorage& storage, const SayCallback& say,
                  const SayCallback& warn) {
    const std::optional<double> automatic = automatic_exposure(film);
    const double exposure = storage.exposure.value_or(automatic.value_or(1.0));
    const bool with_exr = !files.image.empty();
    if (with_exr) {
        ImageMetadata with_names = metadata;
        if (!files.ids.empty()) add_id_names(names, with_names);
        write_exr(files.image, film, with_names, storage.exr);
        if (!files.ids.empty()) write_id_table(files.ids, names);
    }
    if (sensor) write_sensor_image(files.sensor, *sensor, metadata);
    metadata["exposure"] = exposure;
    if (!files.preview.empty()) write_preview(files.preview, film, storage, exposure, metadata);
    warn_of_darkness(film, !automatic, warn);
    if (with_exr && storage.exr.precision == ExrOptions::Precision::half) warn_of_half(film, warn);
    if (with_exr) say(fmt::format("wrote {}", files.image.string()));
    if (!files.ids.empty()) say(fmt::format("wrote {} (names of ids)", files.ids.string()));
    if (sensor) say(fmt::format("wrote {} (the camera's image)", files.sensor.string()));
    if (files.preview.empty()) return;
    say(fmt::format("wrote {} ({}{})", files.preview.string(), with_exr ? "preview, " : "",
                    automatic ? fmt::format("R G B x {:.4g}", exposure) : "black"));
}

}  // namespace uw
