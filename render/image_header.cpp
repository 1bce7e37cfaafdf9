#include "render/image_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "core/base/json_string.h"
#include "core/base/text.h"
#include "core/base/version.h"
#include "core/image/cryptomatte.h"
#include "core/image/exr_file.h"
#include "core/image/image_quantity.h"
#include "core/light/integrator_table.h"

namespace uw {

namespace {

using NameList = std::vector<SurfaceName>;

constexpr std::size_t k_longest_name = 4096;

std::string names_by_number(const NameList& list) {
    std::string text = "{";
    for (std::size_t k = 0; k < list.size(); ++k) {
        text += fmt::format("{}\"{}\":{}", k == 0 ? "" : ",", k + 1, json_string(list[k].name));
    }
    return text + "}";
}

// Returns a field of a CSV file (RFC 4180), on one line.
std::string csv_field(const std::string& text) {
    const std::string line = printable(text, k_longest_name);
    if (line.find_first_of(",\"") == std::string::npos) return line;
    std::string quoted = "\"";
    for (const char c : line) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

}  // namespace

bool requests_ids(std::string_view layers) {
    return std::ranges::any_of(split(layers, ','), [](std::string_view part) {
        const std::string_view item = trimmed(part, " \t");
        return item == "id" || item == "material" || item == "all";
    });
}

std::filesystem::path id_table_beside(const std::filesystem::path& image) {
    std::filesystem::path table = image;
    table.replace_extension();
    table += "_ids.csv";
    return table;
}

void add_id_names(const SurfaceNames& names, ImageMetadata& metadata) {
    metadata["uwvdb/id_names"] = names_by_number(names.objects);
    metadata["uwvdb/material_names"] = names_by_number(names.materials);
}

void add_matte_manifests(const SurfaceNames& names, const std::vector<std::string>& channel_names,
                         ImageMetadata& metadata) {
    const auto add = [&](MatteOf of, const NameList& list) {
        if (std::ranges::find(channel_names, matte_channels(of).front()) == channel_names.end())
            return;
        std::vector<std::string> texts;
        for (const SurfaceName& surface : list) texts.push_back(surface.name);
        add_matte_header(of, texts, metadata);
    };
    add(MatteOf::objects, names.objects);
    add(MatteOf::materials, names.materials);
}

void write_id_table(OutputFile& out, const SurfaceNames& names) {
    out.write("layer,number,name,geometry\n");
    const auto write = [&](const char* layer, const NameList& list) {
        for (std::size_t k = 0; k < list.size(); ++k)
            out.write(fmt::format("{},{},{},{}\n", layer, k + 1, csv_field(list[k].name),
                                  list[k].entry ? fmt::format("{}", *list[k].entry) : ""));
    };
    write("id", names.objects);
    write("material", names.materials);
}

namespace {

std::string band_list(std::span<const double> values) {
    std::string text;
    for (const double value : values)
        text += fmt::format("{}{:g}", text.empty() ? "" : ", ", value);
    return text;
}

// Returns the first three rows of the 4 x 4 matrix, whose last row is 0 0 0 1.
std::string matrix_rows(const Affine& pose) {
    std::string text;
    for (int row = 0; row < 3; ++row)
        text += fmt::format("{}{:.17g} {:.17g} {:.17g} {:.17g}", text.empty() ? "" : "; ",
                            pose.linear()[0][row], pose.linear()[1][row], pose.linear()[2][row],
                            pose.offset()[row]);
    return text;
}

// Returns the name of the space of RGB channels, as make_band_colour interprets the description.
std::string rgb_space(const ColourDesc& colour, std::size_t bands) {
    using Response = ColourDesc::Response;
    if (colour.response == Response::camera) return "of the camera";
    const bool shows_bands =
        bands == 3 && colour.response != Response::cie && !colour.white && !colour.raw;
    return shows_bands ? "bands" : std::string(k_linear_srgb);
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

ImageMetadata metadata_of(const ImageScene& image, std::optional<int> frame,
                          const PathRequest& paths) {
    const SceneDesc& scene = image.desc();
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
                    {k_rgb_space, rgb_space(scene.render.colour, scene.water.bands_nm.size())},
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
    if (image.time()) m["uwvdb/time_s"] = *image.time();
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
    // The wavelength of rays and ground truth: the port refracts light of other wavelengths
    // differently.
    if (disperses(scene.camera)) m["uwvdb/wavelength_nm"] = scene.camera.wavelength_nm;
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
    ImageMetadata m = metadata_of(scene.image, frame, paths);
    if (report.paths.samples > 0) m["uwvdb/samples"] = static_cast<double>(report.paths.samples);
    if (report.paths.error) m["uwvdb/error"] = *report.paths.error;
    if (report.multiple_error) {
        m["uwvdb/multiple_error"] = *report.multiple_error;
        m["uwvdb/multiple_error_of_bands"] = band_list(report.multiple_error_of_bands);
        m["uwvdb/multiple_error_of_parts"] = report.multiple_error_of_parts;
        m["uwvdb/multiple_error_of_worst_part"] = report.multiple_error_of_worst_part;
    }
    if (report.exposure_parts > 0) {
        m["uwvdb/exposure_parts"] = static_cast<double>(report.exposure_parts);
        m["uwvdb/exposure_samples"] = static_cast<double>(report.exposure_samples);
    }
    if (report.colour_groups > 1)
        m["uwvdb/colour_groups"] = static_cast<double>(report.colour_groups);
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
    if (scene.slabs) {
        m["uwvdb/slab_near_m"] = scene.slabs->near;
        m["uwvdb/slab_thickness_m"] = scene.slabs->thickness();
        m["uwvdb/slabs"] = static_cast<double>(scene.slabs->count);
    }
    return m;
}

}  // namespace uw
