#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>

#include "camera/calibration.h"
#include "core/base/text.h"
#include "core/scene/camera_desc.h"

namespace uw {

// Cameras in the settings of programs for visual odometry and mapping. All have OpenCV's lenses,
// and the centre of the first pixel at (0, 0).

namespace {

constexpr auto k_four_hint = "give the four numbers that go with the distortion model";

std::vector<double> numbers_in(std::span<const ConfigValue> values, std::string_view hint) {
    std::vector<double> numbers;
    for (const ConfigValue& value : values) numbers.push_back(value.number(hint));
    return numbers;
}

/// The numbers of a list of exactly `count`.
std::vector<double> numbers_of(const ConfigValue& value, std::size_t count, std::string_view hint) {
    return numbers_in(value.list_of(count, hint), hint);
}

/// Rejects an unknown lens model, and lists the known ones.
[[noreturn]] void refuse_model(const ConfigValue& value, std::string_view supported) {
    value.fail(fmt::format("the camera model {} is not supported; calibrate with {}",
                           printable(value.node().scalar), supported));
}

/// Whether a key of the map has this prefix.
bool has_key_beginning(const ConfigNode& map, std::string_view begin) {
    for (const ConfigNode::Entry& entry : map.entries)
        if (entry.key.starts_with(begin)) return true;
    return false;
}

}  // namespace

// EuRoC's sensor.yaml, as all data sets of the ASL format have one in the folder of each sensor.

bool looks_like_euroc(const ConfigNode& root) {
    return root.find("sensor_type") != nullptr ||
           (root.find("camera_model") != nullptr && root.find("intrinsics") != nullptr);
}

Calibration read_euroc_sensor(const ConfigValue& root) {
    if (const ConfigNode* const type = root.node().find("sensor_type"))
        if (type->scalar != "camera")
            root.fail(fmt::format("is of the sensor '{}', not of a camera; name cam0/sensor.yaml",
                                  printable(type->scalar)));
    Calibration result;
    result.format = CalibrationFormat::euroc;
    const ConfigValue projection = require_value(root, "camera_model", "give pinhole");
    if (projection.text("give pinhole") != "pinhole") refuse_model(projection, "pinhole");
    constexpr auto k_hint = "give [fu, fv, cu, cv] in pixels";
    const auto numbers = require_value(root, "intrinsics", k_hint).list_of(4, k_hint);
    result.desc.intrinsics = intrinsics_from_zero(numbers, k_hint);
    const ConfigValue resolution =
        require_value(root, "resolution", "give [width, height] in pixels");
    const auto sides = resolution.list_of(2, "give [width, height] in pixels");
    read_resolution(resolution, sides[0], sides[1], result.desc);

    enum class Lens : std::uint8_t { radial_tangential, equidistant, none };
    constexpr std::array<std::pair<std::string_view, Lens>, 4> k_lenses{
        {{"radial-tangential", Lens::radial_tangential},
         {"radtan", Lens::radial_tangential},
         {"equidistant", Lens::equidistant},
         {"none", Lens::none}}};
    const ConfigValue model = require_value(root, "distortion_model", "give radial-tangential");
    const Lens lens = model.choice(k_lenses);
    result.model = "pinhole, " + model.node().scalar;
    if (lens == Lens::none) return result;
    const auto d =
        numbers_of(require_value(root, "distortion_coefficients", k_four_hint), 4, k_four_hint);
    result.desc.distortion = lens == Lens::equidistant ? fisheye_lens(d) : opencv_lens(d);
    return result;
}

// The list `cameras` of OKVIS's settings, config_fpga_p2_euroc.yaml and so on. They have no names:
// here they are cam0, cam1, ...

namespace {

constexpr std::string_view k_okvis_models = "radialtangential, radialtangential8 or equidistant";

void read_okvis_lens(const ConfigValue& camera, Calibration& result) {
    const ConfigValue model =
        require_value(camera, "distortion_type", fmt::format("give {}", k_okvis_models));
    const std::string name = model.text("name the lens");
    result.model = name;
    const bool is_rational = name == "radialtangential8", is_fisheye = name == "equidistant";
    if (!is_rational && !is_fisheye && name != "radialtangential")
        refuse_model(model, k_okvis_models);
    const ConfigValue list = require_value(camera, "distortion_coefficients", k_four_hint);
    const auto d = numbers_of(list, is_rational ? 8 : 4, k_four_hint);
    result.desc.distortion = is_fisheye ? fisheye_lens(d) : opencv_lens(d);
}

}  // namespace

bool looks_like_okvis(const ConfigNode& root) {
    const ConfigNode* const cameras = root.find("cameras");
    if (cameras == nullptr) return false;
    for (const ConfigNode& camera : cameras->items)
        if (camera.find("focal_length") != nullptr || camera.find("distortion_type") != nullptr)
            return true;
    return false;
}

Calibration read_okvis(const ConfigValue& root, const std::string& camera) {
    Calibration result;
    result.format = CalibrationFormat::okvis;
    const auto cameras = require_value(root, "cameras", "list them").list("list the cameras");
    for (std::size_t i = 0; i < cameras.size(); ++i)
        result.cameras.push_back(fmt::format("cam{}", i));
    result.camera = choose_camera(result.cameras, camera, root.location());
    const auto index = std::ranges::find(result.cameras, result.camera) - result.cameras.begin();
    const ConfigValue& chosen = cameras[static_cast<std::size_t>(index)];
    const auto pair = [&](std::string_view key, std::string_view hint) {
        return require_value(chosen, key, hint).list_of(2, hint);
    };
    constexpr auto k_focal = "give [fu, fv] in pixels", k_centre = "give [cu, cv] in pixels";
    const auto f = pair("focal_length", k_focal), c = pair("principal_point", k_centre);
    result.desc.intrinsics = intrinsics_from_zero(std::array{f[0], f[1], c[0], c[1]}, k_focal);
    constexpr auto k_size = "give [width, height] in pixels";
    const ConfigValue size = require_value(chosen, "image_dimension", k_size);
    const auto sides = size.list_of(2, k_size);
    read_resolution(size, sides[0], sides[1], result.desc);
    read_okvis_lens(chosen, result);
    return result;
}

// ORB-SLAM's settings: keys with dots, "Camera.fx" up to ORB-SLAM2 and in the first files of
// ORB-SLAM3, "Camera1.fx" in its later ones. Those of rectified stereo have the unrectified
// cameras, with K, D, width and height each, as LEFT and RIGHT.

namespace {

constexpr std::string_view k_orb_models = "PinHole, KannalaBrandt8 or Rectified";

std::string key_of(const std::string& camera, std::string_view name) {
    return fmt::format("{}.{}", camera, name);
}

/// A number of a camera; none if the file does not have it.
std::optional<double> orb_number(const ConfigValue& root, const std::string& camera,
                                 std::string_view name) {
    const std::string key = key_of(camera, name);
    const ConfigNode* const node = root.node().find(key);
    if (node == nullptr) return std::nullopt;
    return ConfigValue(*node, key).number("give a number");
}

/// The lens of "Camera.type", without which it is a pinhole's, as in ORB-SLAM2.
void read_orb_lens(const ConfigValue& root, const std::string& camera, Calibration& result) {
    const ConfigNode* const type = root.node().find("Camera.type");
    result.model = type == nullptr ? "PinHole" : type->scalar;
    const auto numbers = [&](std::initializer_list<std::string_view> names) {
        std::vector<double> found;
        for (const std::string_view name : names)
            found.push_back(orb_number(root, camera, name).value_or(0));
        return found;
    };
    if (result.model == "KannalaBrandt8")
        result.desc.distortion = fisheye_lens(numbers({"k1", "k2", "k3", "k4"}));
    else if (result.model == "PinHole")
        result.desc.distortion = opencv_lens(numbers({"k1", "k2", "p1", "p2", "k3"}));
    else if (result.model != "Rectified")
        refuse_model({*type, "Camera.type"}, k_orb_models);
}

/// A camera of rectified stereo before rectification.
void read_unrectified(const ConfigValue& root, const std::string& camera, Calibration& result) {
    constexpr auto k_matrix = "give the nine numbers fx 0 cx 0 fy cy 0 0 1";
    constexpr auto k_coefficients = "give k1 k2 p1 p2 k3";
    const ConfigValue matrix = require_value(root, key_of(camera, "K"), k_matrix);
    const auto m = matrix_numbers(matrix, k_matrix);
    if (m.size() != 9) matrix.fail(fmt::format("expected 9 numbers; {}", k_matrix));
    result.desc.intrinsics = intrinsics_from_zero(std::array{m[0], m[4], m[2], m[5]}, k_matrix);
    const ConfigValue lens = require_value(root, key_of(camera, "D"), k_coefficients);
    const auto d = matrix_numbers(lens, k_coefficients);
    if (d.size() != 4 && d.size() != 5)
        lens.fail(fmt::format("expected 4 or 5 numbers; {}", k_coefficients));
    result.desc.distortion = opencv_lens(numbers_in(d, k_coefficients));
    result.model = "PinHole, before its rectification";
}

}  // namespace

bool looks_like_orb_slam(const ConfigNode& root) {
    return has_key_beginning(root, "Camera.") || has_key_beginning(root, "Camera1.");
}

Calibration read_orb_slam(const ConfigValue& root, const std::string& camera) {
    Calibration result;
    result.format = CalibrationFormat::orb_slam;
    for (const char* const name : {"Camera", "Camera1", "Camera2"})
        if (root.node().find(key_of(name, "fx")) != nullptr) result.cameras.emplace_back(name);
    for (const char* const name : {"LEFT", "RIGHT"})
        if (root.node().find(key_of(name, "K")) != nullptr) result.cameras.emplace_back(name);
    if (result.cameras.empty())
        require_value(root, "Camera.fx", "give fx, fy, cx and cy in pixels");
    result.camera = choose_camera(result.cameras, camera, root.location());
    const bool is_unrectified = result.camera == "LEFT" || result.camera == "RIGHT";
    const std::string size_of = is_unrectified ? result.camera : "Camera";
    constexpr auto k_size = "give the image's size in pixels, which ORB-SLAM3 needs";
    const ConfigValue width = require_value(root, key_of(size_of, "width"), k_size);
    read_resolution(width, width, require_value(root, key_of(size_of, "height"), k_size),
                    result.desc);
    if (is_unrectified) {
        read_unrectified(root, result.camera, result);
        return result;
    }
    constexpr auto k_hint = "give fx, fy, cx and cy in pixels";
    const auto value = [&](std::string_view name) {
        return require_value(root, key_of(result.camera, name), k_hint);
    };
    result.desc.intrinsics = intrinsics_from_zero(
        std::array{value("fx"), value("fy"), value("cx"), value("cy")}, k_hint);
    read_orb_lens(root, result.camera, result);
    for (const char* const key : {"Camera.newWidth", "Camera.newHeight", "Camera.imageScale"})
        if (const ConfigNode* const node = root.node().find(key); node && node->scalar != "1.0")
            result.warnings.push_back(fmt::format(
                "{}: is the size to which ORB-SLAM takes images; the camera is that of "
                "{} x {} pixels",
                ConfigValue(*node, key).location(), result.desc.width, result.desc.height));
    return result;
}

// CamOdoCal's cameras. VINS has them in its settings; Pinax (uw-calibration-pinax) reads them as
// camera_left.yaml and camera_right.yaml.

bool looks_like_camodocal(const ConfigNode& root) {
    return root.find("model_type") != nullptr && root.find("projection_parameters") != nullptr;
}

Calibration read_camodocal(const ConfigValue& root) {
    Calibration result;
    result.format = CalibrationFormat::camodocal;
    if (const ConfigNode* const name = root.node().find("camera_name"))
        result.camera = name->scalar;
    const ConfigValue model = require_value(root, "model_type", "give PINHOLE or KANNALA_BRANDT");
    result.model = model.text("give PINHOLE or KANNALA_BRANDT");
    const bool is_fisheye = result.model == "KANNALA_BRANDT";
    if (!is_fisheye && result.model != "PINHOLE") refuse_model(model, "PINHOLE or KANNALA_BRANDT");
    constexpr auto k_size = "give image_width and image_height in pixels";
    const ConfigValue width = require_value(root, "image_width", k_size);
    read_resolution(width, width, require_value(root, "image_height", k_size), result.desc);
    const ConfigValue projection =
        require_value(root, "projection_parameters", "give the four of the projection");
    const auto values = [&](const ConfigValue& map, std::array<std::string_view, 4> names) {
        constexpr auto k_hint = "give it as CamOdoCal writes it";
        return std::array{
            require_value(map, names[0], k_hint), require_value(map, names[1], k_hint),
            require_value(map, names[2], k_hint), require_value(map, names[3], k_hint)};
    };
    const std::array<std::string_view, 4> k_fisheye{"mu", "mv", "u0", "v0"};
    const std::array<std::string_view, 4> k_pinhole{"fx", "fy", "cx", "cy"};
    constexpr auto k_pixels = "give it in pixels";
    result.desc.intrinsics =
        intrinsics_from_zero(values(projection, is_fisheye ? k_fisheye : k_pinhole), k_pixels);
    // r = theta + k2 theta^3 + k3 theta^5 + k4 theta^7 + k5 theta^9: cv::fisheye's k1 to k4.
    const auto lens = is_fisheye ? values(projection, {"k2", "k3", "k4", "k5"})
                                 : values(require_value(root, "distortion_parameters", k_four_hint),
                                          {"k1", "k2", "p1", "p2"});
    const auto d = numbers_in(lens, k_four_hint);
    result.desc.distortion = is_fisheye ? fisheye_lens(d) : opencv_lens(d);
    return result;
}

// Matisse's cameras (IFREMER), by OpenCV's FileStorage.

bool looks_like_matisse(const ConfigNode& root) {
    return root.find("full_sensor_width") != nullptr && root.find("K") != nullptr;
}

Calibration read_matisse(const ConfigValue& root) {
    Calibration result;
    result.format = CalibrationFormat::matisse;
    if (const ConfigNode* const name = root.node().find("camera_name"))
        result.camera = name->scalar;
    constexpr auto k_size = "give full_sensor_width and full_sensor_height in pixels";
    const ConfigValue width = require_value(root, "full_sensor_width", k_size);
    read_resolution(width, width, require_value(root, "full_sensor_height", k_size), result.desc);
    constexpr auto k_matrix = "give the nine numbers fx 0 cx 0 fy cy 0 0 1";
    const ConfigValue matrix = require_value(root, "K", k_matrix);
    const auto m = matrix_numbers(matrix, k_matrix);
    if (m.size() != 9) matrix.fail(fmt::format("expected 9 numbers; {}", k_matrix));
    result.desc.intrinsics = intrinsics_from_zero(std::array{m[0], m[4], m[2], m[5]}, k_matrix);

    constexpr auto k_model = "give 0, 1 or 2 (radial and tangential) or 3 (fisheye)";
    constexpr auto k_lens = "give k1 k2 p1 p2 k3, or k1 k2 k3 k4 of a fisheye";
    const bool is_fisheye =
        require_value(root, "distortion_model", k_model).integer(0, 3, k_model) == 3;
    const ConfigValue list = require_value(root, "distortion_coeff", k_lens);
    std::vector<double> d = numbers_in(matrix_numbers(list, k_lens), k_lens);
    // Cameras that were never calibrated have three zeros.
    const std::size_t most = is_fisheye ? 4 : 5;
    const bool is_cut = d.size() < 4 && std::ranges::any_of(d, [](double k) { return k != 0; });
    if (is_cut || d.size() > 5 || (is_fisheye && d.size() == 5 && d[4] != 0))
        list.fail(fmt::format("expected {} numbers, found {}; {}", most, d.size(), k_lens));
    d.resize(most);
    result.desc.distortion = is_fisheye ? fisheye_lens(d) : opencv_lens(d);
    result.model = is_fisheye ? "fisheye" : "radial and tangential";
    return result;
}

}  // namespace uw
