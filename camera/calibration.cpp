#include "camera/calibration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"
#include "core/scene/yaml_document.h"

namespace uw {

ConfigValue require_value(const ConfigValue& map, std::string_view key, std::string_view hint) {
    const ConfigNode* const node = map.node().find(key);
    if (node == nullptr) map.fail(fmt::format("'{}' is missing; {}", key, hint));
    const std::string path =
        map.path().empty() ? std::string(key) : fmt::format("{}.{}", map.path(), key);
    return {*node, path};
}

std::string number_list(std::span<const double> numbers) {
    return fmt::format("[{}]", fmt::join(numbers, ", "));
}

namespace {

/// Names for a message: the first few of them.
std::string some_names(const std::vector<std::string>& names) {
    constexpr std::size_t k_max_listed = 8;
    std::vector<std::string> some;
    for (std::size_t i = 0; i < std::min(names.size(), k_max_listed); ++i)
        some.push_back(printable(names[i], 30));
    return fmt::format("{}{}", fmt::join(some, ", "), names.size() > k_max_listed ? ", ..." : "");
}

}  // namespace

std::string choose_camera(const std::vector<std::string>& names, const std::string& wanted,
                          const std::string& where) {
    if (names.empty()) throw InputError(where + ": contains no camera; give another file");
    if (wanted.empty()) {
        if (names.size() == 1) return names.front();
        throw InputError(fmt::format(
            "{}: has {} cameras ({}); choose one: calibration: {{file: ..., camera: {}}} in a "
            "scene, --camera {} on the command line",
            where, names.size(), some_names(names), printable(names.front(), 30),
            printable(names.front(), 30)));
    }
    if (std::ranges::find(names, wanted) != names.end()) return wanted;
    throw InputError(fmt::format("{}: has no camera '{}'; it has {}", where, printable(wanted),
                                 some_names(names)));
}

bool is_distorted(const DistortionDesc& distortion) {
    return has_radial_above(distortion, 0) || distortion.p[0] != 0 || distortion.p[1] != 0;
}

bool has_radial_above(const DistortionDesc& distortion, std::size_t count) {
    return std::any_of(distortion.k.begin() + static_cast<std::ptrdiff_t>(count),
                       distortion.k.end(), [](double k) { return k != 0; });
}

namespace {

constexpr std::array<CalibrationFormat, 6> k_formats{
    CalibrationFormat::opencv,   CalibrationFormat::ros,    CalibrationFormat::kalibr,
    CalibrationFormat::calibmar, CalibrationFormat::colmap, CalibrationFormat::scene};

constexpr auto k_known =
    "the known formats are OpenCV and ROS YAML (camera_matrix, distortion_coefficients) and ROS's "
    "camera_info, Kalibr's camchain.yaml (cam0: {camera_model, intrinsics, ...}), Calibmar's "
    "calibration.yaml (model, parameters, non_svp_model), COLMAP's cameras.txt (1 OPENCV 1920 1080 "
    "...), EuRoC's sensor.yaml, and the cameras of OKVIS, ORB-SLAM, CamOdoCal (VINS, Pinax) and "
    "Matisse";

/// Puts a blank behind the colon of keys such as "data:[1, 2]", which OpenCV reads without.
std::string with_blanks(std::string_view text) {
    std::string result;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string_view line = text.substr(begin, std::min(end + 1, text.size()) - begin);
        const std::size_t key = std::min(line.find_first_not_of(' '), line.size());
        const std::size_t colon = line.find(':');
        constexpr std::string_view k_name =
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
        const bool is_key = colon != std::string_view::npos && colon > key &&
                            line.find_first_not_of(k_name, key) == colon;
        result += line.substr(0, is_key ? colon + 1 : 0);
        const std::string_view rest = line.substr(is_key ? colon + 1 : 0);
        constexpr std::string_view k_blanks = " \t\r\n";
        if (is_key && !rest.empty() && k_blanks.find(rest.front()) == std::string_view::npos)
            result += ' ';
        result += rest;
        begin = end + 1;
    }
    return result;
}

/// Converts the output of programs to valid YAML without moving lines: OpenCV's "%YAML:1.0" lacks a
/// space, and its values have type tags; `ros2 topic echo` ends each message with "---".
std::string as_yaml(std::string text) {
    const auto blank = [&](std::size_t begin, std::size_t length) {
        for (std::size_t i = begin; i < begin + length; ++i) text[i] = ' ';
    };
    constexpr std::string_view k_blanks = " \t\r\n", k_end = "---";
    const std::size_t last = text.find_last_not_of(k_blanks);
    if (last != std::string::npos && last >= k_end.size() &&
        std::string_view(text).substr(last - 2, 3) == k_end && text[last - 3] == '\n')
        blank(last - 2, k_end.size());
    if (text.starts_with("%YAML")) {
        blank(0, std::min(text.find('\n'), text.size()));
        text = with_blanks(text);
    }
    constexpr std::string_view k_tag = "!!opencv-matrix";
    for (std::size_t at = text.find(k_tag); at != std::string::npos; at = text.find(k_tag, at))
        blank(at, k_tag.size());
    return text;
}

/// Pinax's calibration_params.txt is lines of a name and a number: the port, and the image that it
/// rectifies to, but no camera.
void refuse_pinax(std::string_view text, const std::string& origin) {
    if (text.find("\nd_cam2panel ") == std::string_view::npos) return;
    throw InputError(fmt::format(
        "{}: has the port of Pinax, and no camera; name CamOdoCal's camera_left.yaml or "
        "camera_right.yaml, and give the scene port: {{type: flat, distance: d_cam2panel, "
        "thickness: "
        "glass_thickness, n_glass: n_glass, n_water: n_water}} with these numbers",
        origin));
}

Calibration read_yaml(const std::string& text, const std::string& origin,
                      const std::string& camera) {
    if (text.find_first_not_of(" \t\r\n") == std::string::npos)
        throw InputError(fmt::format("{}: is empty; {}", origin, k_known));
    refuse_pinax(text, origin);
    const ConfigNode node = parse_yaml(as_yaml(text), origin, {.subject = "calibration"});
    const ConfigValue root(node, "");
    if (node.find("uwvdb") != nullptr)
        root.fail("is a scene, not a calibration; copy its camera instead");
    if (looks_like_euroc(node)) return read_euroc_sensor(root);
    if (looks_like_okvis(node)) return read_okvis(root, camera);
    if (looks_like_orb_slam(node)) return read_orb_slam(root, camera);
    if (looks_like_camodocal(node)) return read_camodocal(root);
    if (looks_like_matisse(node)) return read_matisse(root);
    if (looks_like_kalibr(node)) return read_kalibr(root, camera);
    if (looks_like_calibmar(node)) return read_calibmar(root);
    if (looks_like_opencv(node)) return read_opencv_yaml(root);
    root.fail(fmt::format("is not in a known calibration format; {}", k_known));
}

}  // namespace

std::span<const CalibrationFormat> calibration_formats() {
    return k_formats;
}

std::string_view word_of(CalibrationFormat format) {
    constexpr std::array<std::string_view, 11> k_words{
        "opencv", "ros",   "kalibr",   "calibmar",  "colmap", "scene",
        "euroc",  "okvis", "orb-slam", "camodocal", "matisse"};
    return k_words[static_cast<std::size_t>(format)];
}

std::string_view title_of(CalibrationFormat format) {
    constexpr std::array<std::string_view, 11> k_titles{
        "OpenCV YAML",        "ROS camera_info YAML", "Kalibr camchain",   "Calibmar calibration",
        "COLMAP cameras.txt", "uwvdb scene",          "EuRoC sensor.yaml", "OKVIS settings",
        "ORB-SLAM settings",  "CamOdoCal camera",     "Matisse camera"};
    return k_titles[static_cast<std::size_t>(format)];
}

Calibration read_calibration(const std::filesystem::path& file, const std::string& camera) {
    const std::string origin = printable(file.string(), 300);
    const std::string text =
        read_text_file(file, origin, YamlLimits{}.bytes, "calibration", Pipes::read);
    Calibration result = looks_like_colmap(text) ? read_colmap(text, origin, camera)
                                                 : read_yaml(text, origin, camera);
    if (result.cameras.empty()) {
        if (!result.camera.empty()) result.cameras.push_back(result.camera);
        if (!camera.empty() && camera != result.camera)
            throw InputError(
                fmt::format("{}: has one camera{}, and none called '{}'; leave the "
                            "camera's name out",
                            origin,
                            result.camera.empty() ? std::string(" without a name")
                                                  : fmt::format(", '{}'", printable(result.camera)),
                            printable(camera)));
    }
    const CameraDesc& desc = result.desc;
    const auto [cx, cy] = std::pair(desc.intrinsics.cx, desc.intrinsics.cy);
    if (!(cx >= 0 && cx <= desc.width && cy >= 0 && cy <= desc.height))
        result.warnings.push_back(fmt::format(
            "{}: the principal point ({:.6g}, {:.6g}) lies outside the image of {} x {} pixels; is "
            "the resolution that of the calibration?",
            origin, cx, cy, desc.width, desc.height));
    result.hash = text_hash(text);
    return result;
}

std::optional<Calibration> apply_calibration(CameraDesc& camera) {
    if (!camera.calibration) return std::nullopt;
    Calibration result = read_calibration(camera.calibration->file, camera.calibration->camera);
    if (camera.port && result.desc.port)
        throw InputError(
            camera.calibration->where +
            ": the file has a port of its own; remove camera.port, or take the numbers of "
            "'uwvdb calibration FILE --to scene' instead of the file");
    camera.width = result.desc.width;
    camera.height = result.desc.height;
    camera.intrinsics = result.desc.intrinsics;
    camera.distortion = result.desc.distortion;
    if (result.desc.port) camera.port = result.desc.port;
    return result;
}

std::string calibration_obstacle(CalibrationFormat format, const CameraDesc& camera) {
    switch (format) {
        case CalibrationFormat::opencv:
        case CalibrationFormat::ros:
            return opencv_obstacle(camera);
        case CalibrationFormat::kalibr:
            return kalibr_obstacle(camera);
        default:
            break;
    }
    return "";
}

std::vector<std::string> calibration_omissions(CalibrationFormat format, const CameraDesc& camera) {
    if (format == CalibrationFormat::scene || !camera.port) return {};
    return std::visit(
        [&](const auto& port) {
            std::vector<std::string> lines;
            if (port.dispersion.any())
                lines.push_back(
                    fmt::format("the file holds indices of one wavelength: these are of {:g} nm",
                                camera.wavelength_nm));
            if (port.fresnel) lines.emplace_back("the file cannot hold the port's fresnel");
            if (port.radiance_in_air)
                lines.emplace_back("the file cannot hold the port's radiance_in");
            return lines;
        },
        *camera.port);
}

std::string write_calibration(CalibrationFormat format, const CameraDesc& camera) {
    switch (format) {
        case CalibrationFormat::opencv:
            return write_opencv(camera);
        case CalibrationFormat::ros:
            return write_ros(camera);
        case CalibrationFormat::kalibr:
            return write_kalibr(camera);
        case CalibrationFormat::calibmar:
            return write_calibmar(camera);
        case CalibrationFormat::colmap:
            return write_colmap(camera);
        default:
            break;
    }
    return write_scene_camera(camera);
}

}  // namespace uw
