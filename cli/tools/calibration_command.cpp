#include "cli/tools/calibration_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <numbers>

#include "camera/camera.h"
#include "cli/console.h"
#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/json.h"
#include "core/base/text.h"
#include "core/base/vector_math.h"
#include "core/base/version.h"
#include "dataset/camera_json.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

const char* const k_calibration_examples = R"(Examples:
  uwvdb calibration calibration.yaml                       what was understood of it
  uwvdb calibration camchain.yaml --camera cam1 --to scene  a scene's camera, to paste
  uwvdb calibration plume.yaml --to colmap -o cameras.txt   a scene's camera for COLMAP

Reads OpenCV and ROS YAML, Kalibr's camchain, Calibmar's calibration.yaml, COLMAP's cameras.txt
(stock and refractive), EuRoC's sensor.yaml, cameras of OKVIS, ORB-SLAM, CamOdoCal (VINS, Pinax) and
Matisse, and scenes; the format is detected from the content. docs/calibration.md has
their models and conventions. Fields of view are through the image's principal point.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write.)";

/// `uwvdb calibration` as typed.
struct CalibrationArguments {
    std::filesystem::path file;               // a calibration, or a scene
    std::string camera;                       // --camera: which of several
    std::optional<CalibrationFormat> format;  // --to
    std::filesystem::path output;             // -o; empty: standard output
    std::optional<double> wavelength;         // --wavelength [nm]
    bool json = false;
};

CalibrationFormat format_called(const std::string& word) {
    std::vector<std::string_view> words;
    for (const CalibrationFormat format : calibration_formats()) {
        words.push_back(word_of(format));
        if (words.back() == word) return format;
    }
    throw UsageError(
        fmt::format("--to {}: unknown format; {}", printable(word), suggestion(word, words)));
}

Options calibration_options(CalibrationArguments& a) {
    Options options;
    options.input("FILE", "", a.file, "a calibration, or a scene").required = true;
    options.text("--camera", "NAME", a.camera,
                 "which of several in the file: cam0, or COLMAP's number");
    Option& to = options.parsed(
        "--to", "FORMAT", [&a](const std::string& word) { a.format = format_called(word); },
        "write it as opencv, ros, kalibr, calibmar, colmap or scene; to standard output, or with "
        "-o to a file");
    to.value = Option::Value::word;
    for (const CalibrationFormat format : calibration_formats())
        to.words.emplace_back(word_of(format));
    options.output("-o,--output", "FILE", a.output, "the file to write").needs = "--to";
    options.number("--wavelength", "NM", a.wavelength, k_shortest_dispersion_nm,
                   k_longest_dispersion_nm,
                   "of light in nm, whose indices a scene's port has; default: the band "
                   "nearest to 550");
    options.flag("--json", a.json, "print what was understood as JSON");
    return options;
}

/// The fraction of covered pixels is sampled at this many positions along each side.
constexpr int k_looks = 256;

/// The angle from the ray at `from` to the last one on the way to `to`; 0 without a ray at `from`.
/// Summed in steps, so that it may exceed 180 degrees.
template <class Direction>
double reach(const Direction& direction, const ImagePoint& from, const ImagePoint& to) {
    constexpr int k_steps = 512;
    auto last = direction(from.x, from.y);
    if (!last) return 0;
    double sum = 0;
    for (int i = 1; i <= k_steps; ++i) {
        const double t = static_cast<double>(i) / k_steps;
        const auto next = direction(from.x + t * (to.x - from.x), from.y + t * (to.y - from.y));
        if (!next) break;
        sum += angle_between(*last, *next);
        last = next;
    }
    return sum;
}

template <class Direction>
FieldOfView field_of_view(const CameraDesc& camera, const Direction& direction) {
    const double w = camera.width, h = camera.height;
    const ImagePoint c{std::clamp(camera.intrinsics.cx, 0.0, w),
                       std::clamp(camera.intrinsics.cy, 0.0, h)};
    const auto across = [&](const ImagePoint& a, const ImagePoint& b) {
        return reach(direction, c, a) + reach(direction, c, b);
    };
    return {across({0, c.y}, {w, c.y}), across({c.x, 0}, {c.x, h}), across({0, 0}, {w, h})};
}

void find_fold(const CameraDesc& camera, CalibrationSurvey& survey) {
    if (camera.distortion.model == DistortionDesc::Model::fisheye) {
        const Fisheye lens(camera.distortion);
        survey.fold_angle = lens.max_angle();
        const auto edge = lens.image(
            {std::sin(0.999999 * *survey.fold_angle), 0, std::cos(0.999999 * *survey.fold_angle)});
        if (edge) survey.fold_radius = camera.intrinsics.fx * edge->x;
        return;
    }
    const Distortion lens(camera.distortion);
    if (!std::isfinite(lens.fold_radius())) return;
    survey.fold_angle = std::atan(lens.fold_radius());
    DistortionDesc radial = camera.distortion;
    radial.p = {};
    survey.fold_radius =
        camera.intrinsics.fx * Distortion(radial).distort({lens.fold_radius(), 0}).x;
}

double covered(const Camera& camera) {
    int with = 0;
    for (int j = 0; j < k_looks; ++j)
        for (int i = 0; i < k_looks; ++i)
            with += camera.refracted_ray((i + 0.5) * camera.width() / k_looks,
                                         (j + 0.5) * camera.height() / k_looks)
                        ? 1
                        : 0;
    return static_cast<double>(with) / (k_looks * k_looks);
}

std::string field_text(const FieldOfView& field) {
    return fmt::format("{:.2f} x {:.2f} deg, diagonal {:.2f}", field.horizontal / k_degree,
                       field.vertical / k_degree, field.diagonal / k_degree);
}

constexpr double k_degrees = 180 / std::numbers::pi;

Json field_json(const FieldOfView& field) {
    return {{"horizontal", field.horizontal * k_degrees},
            {"vertical", field.vertical * k_degrees},
            {"diagonal", field.diagonal * k_degrees}};
}

std::string glass(const auto& port) {
    return fmt::format("glass {:.6g} m thick; indices {:.6g} (air), {:.6g} (glass), {:.6g} (water)",
                       port.thickness, port.n_air, port.n_glass, port.n_water);
}

std::string port_text(const PortDesc& port) {
    if (const auto* dome = std::get_if<DomePortDesc>(&port)) {
        return fmt::format(
            "dome: centre [{:.6g}, {:.6g}, {:.6g}] m, {:.6g} m off the camera; inner radius {:.6g} "
            "m, {}",
            dome->center.x, dome->center.y, dome->center.z, glm::length(from_origin(dome->center)),
            dome->radius, glass(*dome));
    }
    const auto& flat = std::get<FlatPortDesc>(port);
    return fmt::format(
        "flat: normal [{:.6g}, {:.6g}, {:.6g}], {:.3f} deg off the axis; {:.6g} m before the "
        "camera, {}",
        flat.normal.x, flat.normal.y, flat.normal.z,
        angle_between(flat.normal, {0, 0, 1}) / k_degree, flat.distance, glass(flat));
}

const char* word_of_lens(const CameraDesc& camera) {
    return camera.distortion.model == DistortionDesc::Model::fisheye ? "fisheye" : "brown-conrady";
}

std::string lens_text(const CameraDesc& camera) {
    const DistortionDesc& d = camera.distortion;
    if (d.model == DistortionDesc::Model::fisheye)
        return fmt::format("fisheye (equidistant), k [{:.6g}, {:.6g}, {:.6g}, {:.6g}]", d.k[0],
                           d.k[1], d.k[2], d.k[3]);
    if (d == DistortionDesc{}) return "none";
    return fmt::format("brown-conrady, k [{:.6g}], p [{:.6g}]", fmt::join(d.k, ", "),
                       fmt::join(d.p, ", "));
}

}  // namespace

CalibrationSurvey survey_calibration(const std::filesystem::path& file,
                                     const Calibration& calibration,
                                     std::span<const double> bands_nm) {
    CalibrationSurvey survey;
    survey.file = file;
    survey.calibration = calibration;
    CameraDesc desc = calibration.desc;
    desc.world_from_camera = Affine{};
    const Camera camera(desc);
    survey.in_lens =
        field_of_view(desc, [&](double x, double y) { return camera.lens_direction(x, y); });
    if (desc.port)
        survey.in_water = field_of_view(desc, [&](double x, double y) -> std::optional<Vector3> {
            const auto ray = camera.refracted_ray(x, y);
            if (!ray) return std::nullopt;
            return ray->direction;
        });
    find_fold(desc, survey);
    survey.covered = covered(camera);
    survey.lateral_colour = band_shifts(desc, bands_nm);
    for (const CalibrationFormat format : calibration_formats())
        survey.targets.push_back({format, calibration_obstacle(format, desc)});
    return survey;
}

Report report_on_calibration(const CalibrationSurvey& survey) {
    const Calibration& calibration = survey.calibration;
    const CameraDesc& camera = calibration.desc;
    const IntrinsicsDesc& i = camera.intrinsics;
    std::string title = fmt::format("{}: {}", printable(survey.file.filename().string(), 200),
                                    title_of(calibration.format));
    if (!calibration.camera.empty()) title += ", camera " + printable(calibration.camera);
    if (calibration.cameras.size() > 1) title += fmt::format(" of {}", calibration.cameras.size());
    Report report(title);
    const auto row = [&report](std::string_view name, const std::string& value) {
        report.say(fmt::format("{:<17}{}", name, value));
    };
    report.set({{"uwvdb", program_version()},
                {"file", survey.file.string()},
                {"format", word_of(calibration.format)},
                {"model", calibration.model},
                {"camera", calibration.camera},
                {"cameras", calibration.cameras},
                {"warnings", calibration.warnings},
                {"units", "pixels from the image's corner, metres, degrees"}});
    row("model", printable(calibration.model));
    row("resolution", fmt::format("{} x {}", camera.width, camera.height));
    report.set({{"resolution", {camera.width, camera.height}}});
    row("focal length", fmt::format("{:.6f}, {:.6f} pixels", i.fx, i.fy));
    row("principal point",
        fmt::format("{:.6f}, {:.6f} pixels from the image's corner", i.cx, i.cy));
    report.set({{"intrinsics", {{"fx", i.fx}, {"fy", i.fy}, {"cx", i.cx}, {"cy", i.cy}}}});
    row("distortion", lens_text(camera));
    report.set({{"distortion",
                 {{"model", word_of_lens(camera)},
                  {"k", camera.distortion.k},
                  {"p", camera.distortion.p}}}});
    if (camera.port) row("port", port_text(*camera.port));
    report.set({{"port", camera.port ? port_json(*camera.port) : Json(nullptr)}});
    row("field of view", field_text(survey.in_lens) + (camera.port ? " in the housing" : ""));
    if (survey.in_water) row("", field_text(*survey.in_water) + " in the water");
    report.set({{"field_of_view_in_housing", field_json(survey.in_lens)},
                {"field_of_view_in_water", field_json(survey.in_water.value_or(survey.in_lens))}});
    if (disperses(camera)) {
        row("", fmt::format("of light of {:g} nm", camera.wavelength_nm));
        row("lateral colour", text_of(survey.lateral_colour));
        Json colours = Json::array();
        for (const auto& [nm, pixels] : survey.lateral_colour)
            colours.push_back({{"wavelength_nm", nm}, {"pixels", pixels}});
        report.set({{"wavelength_nm", camera.wavelength_nm}, {"lateral_colour", colours}});
    }
    if (survey.fold_angle)
        row("lens shows",
            fmt::format("up to {:.3f} deg off the axis{}", *survey.fold_angle / k_degree,
                        survey.fold_radius ? fmt::format(", {:.1f} pixels from the principal point",
                                                         *survey.fold_radius)
                                           : std::string()));
    if (survey.covered < 1)
        row("", fmt::format("{:.1f} % of the pixels have a ray", 100 * survey.covered));
    report.set(
        {{"fold_angle", survey.fold_angle ? Json(*survey.fold_angle * k_degrees) : Json(nullptr)},
         {"fold_radius", survey.fold_radius ? Json(*survey.fold_radius) : Json(nullptr)},
         {"pixels_with_a_ray", survey.covered}});
    std::vector<std::string_view> words;
    std::map<std::string, std::vector<std::string_view>> obstacles;
    for (const auto& target : survey.targets)
        (target.obstacle.empty() ? words : obstacles[target.obstacle])
            .push_back(word_of(target.format));
    row("--to", fmt::format("{}", fmt::join(words, ", ")));
    for (const auto& [obstacle, formats] : obstacles)
        row("", fmt::format("not {}: {}", fmt::join(formats, ", "), obstacle));
    report.set({{"to", words}});
    return report;
}

bool is_scene(const std::filesystem::path& file) {
    constexpr std::streamsize k_look = 1 << 16;
    std::string text(k_look, '\0');
    std::ifstream stream = open_own_file(file);
    stream.read(text.data(), k_look);
    text.resize(static_cast<std::size_t>(stream.gcount()));
    return text.starts_with("uwvdb:") || text.find("\nuwvdb:") != std::string::npos;
}

namespace {

/// `bands_nm`: those of a scene, in any order.
Calibration read_subject(const CalibrationArguments& a, std::vector<double>& bands_nm) {
    if (!is_scene(a.file)) return read_calibration(a.file, a.camera);
    if (!a.camera.empty()) throw UsageError("--camera: a scene has one camera; leave --camera out");
    const SceneDesc scene = load_scene(a.file, {});
    Calibration result;
    result.format = CalibrationFormat::scene;
    result.model = word_of_lens(scene.camera);
    result.desc = scene.camera;
    bands_nm = scene.water.bands_nm;
    return result;
}

/// "cameras.txt" to "cameras-plain.txt".
std::filesystem::path plain_name(const std::filesystem::path& path) {
    std::filesystem::path name = path;
    return name.replace_filename(path.stem().string() + "-plain" + path.extension().string());
}

void run_calibration(const CalibrationArguments& a) {
    if (a.json && a.format && a.output.empty())
        throw UsageError(
            "--json: --to already writes to standard output; give -o for the file, or leave one of "
            "them out");
    std::vector<double> bands_nm;
    Calibration calibration = read_subject(a, bands_nm);
    if (a.wavelength) set_wavelength(calibration.desc, *a.wavelength);
    for (const std::string& warning : calibration.warnings)
        print_message(fmt::format("warning: {}\n", warning));
    if (a.format) {
        const std::string obstacle = calibration_obstacle(*a.format, calibration.desc);
        if (!obstacle.empty())
            throw UsageError(fmt::format("--to {}: {}", word_of(*a.format), obstacle));
        for (const std::string& line : calibration_omissions(*a.format, calibration.desc))
            print_message(fmt::format("warning: {}: {}\n", word_of(*a.format), line));
        const std::string text = write_calibration(*a.format, calibration.desc);
        if (a.output.empty()) return print_output(text);
        const bool plain = *a.format == CalibrationFormat::colmap && calibration.desc.port;
        TextFiles files;  // both, or neither
        files.add(a.output, text);
        if (plain) {
            CameraDesc bare = calibration.desc;
            bare.port.reset();
            files.add(plain_name(a.output), write_calibration(*a.format, bare));
        }
        files.commit();
    }
    print_output(
        report_on_calibration(survey_calibration(a.file, calibration, bands_nm)).printed(a.json));
}

}  // namespace

Command calibration_command() {
    const auto arguments = std::make_shared<CalibrationArguments>();
    return {"calibration", "show what a camera calibration says, and convert it",
            k_calibration_examples, calibration_options(*arguments), [arguments] {
                run_calibration(*arguments);
                return k_exit_done;
            }};
}

}  // namespace uw
