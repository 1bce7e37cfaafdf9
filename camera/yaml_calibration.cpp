#include <fmt/format.h>

#include <array>
#include <span>

#include "camera/calibration.h"
#include "core/base/text.h"
#include "core/scene/camera_desc.h"

namespace uw {

// The YAML of OpenCV's FileStorage, as its calibration sample writes it, and of ROS camera_info.
// First pixel's centre at (0, 0).

namespace {

using Names = std::span<const std::string_view>;
constexpr std::array<std::string_view, 4> k_matrix_names{"camera_matrix", "Camera_Matrix",
                                                         "cameraMatrix", "K"};
constexpr std::array<std::string_view, 4> k_coefficient_names{
    "distortion_coefficients", "Distortion_Coefficients", "distCoeffs", "D"};
constexpr std::array<std::string_view, 2> k_width_names{"image_width", "image_Width"};
constexpr std::array<std::string_view, 2> k_height_names{"image_height", "image_Height"};

const ConfigNode* find_any(const ConfigNode& map, Names names) {
    for (const std::string_view name : names)
        if (const ConfigNode* const node = map.find(name)) return node;
    return nullptr;
}

/// The value of the first of several keys that is present.
ConfigValue require_any(const ConfigValue& map, Names names, std::string_view mend) {
    for (const std::string_view name : names)
        if (const ConfigNode* const node = map.node().find(name)) return {*node, std::string(name)};
    return require_value(map, names.front(), mend);
}

/// The numbers of a matrix: {rows, cols, data: [...]}, or a plain list.
std::vector<ConfigValue> numbers_of(const ConfigValue& value, std::string_view mend) {
    if (value.node().kind != ConfigNode::Kind::map) return value.list(mend);
    const auto numbers = require_value(value, "data", mend).list(mend);
    const ConfigNode* const rows = value.node().find("rows");
    const ConfigNode* const cols = value.node().find("cols");
    if (rows == nullptr || cols == nullptr) return numbers;
    constexpr int k_most = 64;
    const int count = ConfigValue(*rows, value.path() + ".rows").integer(0, k_most, mend) *
                      ConfigValue(*cols, value.path() + ".cols").integer(0, k_most, mend);
    if (static_cast<std::size_t>(count) != numbers.size())
        value.fail(fmt::format("rows x cols is {}, but data has {} numbers; {}", count,
                               numbers.size(), mend));
    return numbers;
}

void read_matrix(const ConfigValue& value, IntrinsicsDesc& intrinsics) {
    constexpr auto k_mend = "give the nine numbers fx 0 cx 0 fy cy 0 0 1";
    const auto m = numbers_of(value, k_mend);
    if (m.size() != 9)
        value.fail(fmt::format("expected 9 numbers, found {}; {}", m.size(), k_mend));
    constexpr std::array<double, 9> k_fixed{-1, 0, -1, 0, -1, -1, 0, 0, 1};
    for (std::size_t i = 0; i < 9; ++i) {
        if (k_fixed[i] >= 0 && m[i].number(k_mend) != k_fixed[i])
            m[i].fail(fmt::format("must be {}, found {}: skewed pixels are not supported; {}",
                                  k_fixed[i], m[i].number(k_mend), k_mend));
    }
    intrinsics = {m[0].positive(k_mend), m[4].positive(k_mend), m[2].number(k_mend) + k_half_pixel,
                  m[5].number(k_mend) + k_half_pixel};
}

/// `unnamed` and `brown_conrady` have any number of coefficients; the former may be a fisheye.
enum class Model : std::uint8_t { unnamed, brown_conrady, plumb_bob, rational, equidistant };

Model read_model(const ConfigValue& root, Calibration& result) {
    if (const ConfigNode* const node = root.node().find("distortion_model")) {
        constexpr std::array<std::pair<std::string_view, Model>, 5> k_models{
            {{"plumb_bob", Model::plumb_bob},
             {"rational_polynomial", Model::rational},
             {"equidistant", Model::equidistant},
             {"fisheye", Model::equidistant},
             {"none", Model::plumb_bob}}};
        result.model = node->scalar;
        return ConfigValue(*node, "distortion_model").choice(k_models);
    }
    const ConfigNode* const fisheye = root.node().find("fisheye_model");
    if (fisheye != nullptr &&
        ConfigValue(*fisheye, "fisheye_model").integer(0, 1, "give 0 or 1") == 1) {
        result.model = "fisheye";
        return Model::equidistant;
    }
    result.model = "plumb_bob";
    return fisheye != nullptr ? Model::brown_conrady : Model::unnamed;
}

void read_coefficients(const ConfigValue& value, Model model, Calibration& result) {
    constexpr auto k_mend = "give k1 k2 p1 p2 [k3 [k4 k5 k6]], or k1 k2 k3 k4 of a fisheye";
    std::vector<double> d;
    for (const ConfigValue& number : numbers_of(value, k_mend)) d.push_back(number.number(k_mend));
    const std::size_t count = d.size();
    const auto refuse = [&](std::string_view expected) {
        value.fail(fmt::format("expected {} numbers, found {}; {}", expected, count, k_mend));
    };
    DistortionDesc& distortion = result.desc.distortion;
    d.resize(std::max<std::size_t>(count, 14));
    if (model == Model::equidistant) {
        if (count != 4) refuse("4");
        distortion.model = DistortionDesc::Model::fisheye;
        distortion.k = {d[0], d[1], d[2], d[3], 0, 0};
        return;
    }
    if (model == Model::plumb_bob && count != 0 && count != 4 && count != 5) refuse("4 or 5");
    if (model == Model::rational && count != 8) refuse("8");
    if (count != 0 && count != 4 && count != 5 && count != 8 && count != 12 && count != 14)
        refuse("0, 4, 5, 8, 12 or 14");
    for (std::size_t i = 8; i < d.size(); ++i)
        if (d[i] != 0)
            value.fail(
                fmt::format("has a {} ({}), which is not supported; calibrate without that model",
                            i < 12 ? "thin-prism coefficient" : "sensor tilt", d[i]));
    distortion.k = {d[0], d[1], d[4], d[5], d[6], d[7]};
    distortion.p = {d[2], d[3]};
    if (count >= 8) result.model = "rational_polynomial";
    if (model == Model::unnamed && count == 4)
        result.warnings.push_back(value.location() +
                                  ": the file names no distortion_model, so the four numbers are "
                                  "taken as k1 k2 p1 p2, as from cv::calibrateCamera; if they come "
                                  "from cv::fisheye, add distortion_model: equidistant");
}

/// OpenCV's order of coefficients.
std::vector<double> coefficients_of(const DistortionDesc& d) {
    if (d.model == DistortionDesc::Model::fisheye) return {d.k[0], d.k[1], d.k[2], d.k[3]};
    std::vector<double> result{d.k[0], d.k[1], d.p[0], d.p[1], d.k[2]};
    if (has_radial_above(d, 3)) result.insert(result.end(), d.k.begin() + 3, d.k.end());
    return result;
}

std::string_view model_of(const DistortionDesc& d) {
    if (d.model == DistortionDesc::Model::fisheye) return "equidistant";
    return has_radial_above(d, 3) ? "rational_polynomial" : "plumb_bob";
}

std::array<double, 9> matrix_of(const IntrinsicsDesc& i) {
    return {i.fx, 0, i.cx - k_half_pixel, 0, i.fy, i.cy - k_half_pixel, 0, 0, 1};
}

std::string matrix_text(std::string_view name, std::size_t rows, std::span<const double> numbers,
                        bool file_storage) {
    return fmt::format("{}:{}\n  rows: {}\n  cols: {}\n{}  data: {}\n", name,
                       file_storage ? " !!opencv-matrix" : "", rows, numbers.size() / rows,
                       file_storage ? "  dt: d\n" : "", number_list(numbers));
}

}  // namespace

bool looks_like_opencv(const ConfigNode& root) {
    return find_any(root, k_matrix_names) != nullptr ||
           find_any(root, k_coefficient_names) != nullptr ||
           root.find("distortion_model") != nullptr;
}

Calibration read_opencv_yaml(const ConfigValue& root) {
    Calibration result;
    const bool is_ros = root.node().find("projection_matrix") != nullptr ||
                        root.node().find("camera_name") != nullptr;
    result.format = is_ros ? CalibrationFormat::ros : CalibrationFormat::opencv;
    if (const ConfigNode* const name = root.node().find("camera_name"))
        result.camera = name->scalar;
    constexpr auto k_size = "give image_width and image_height in pixels";
    const ConfigValue width = require_any(root, k_width_names, k_size);
    read_resolution(width, width, require_any(root, k_height_names, k_size), result.desc);
    read_matrix(require_any(root, k_matrix_names, "give camera_matrix: {rows: 3, cols: 3, data}"),
                result.desc.intrinsics);
    const Model model = read_model(root, result);
    read_coefficients(
        require_any(root, k_coefficient_names, "give distortion_coefficients: {data: [...]}"),
        model, result);
    return result;
}

std::string opencv_obstacle(const CameraDesc& camera) {
    return camera.port ? "OpenCV and ROS files have no ports; write calibmar or colmap" : "";
}

std::string write_opencv(const CameraDesc& camera) {
    const DistortionDesc& d = camera.distortion;
    const std::vector<double> coefficients = coefficients_of(d);
    return fmt::format("%YAML:1.0\n---\nimage_width: {}\nimage_height: {}\n", camera.width,
                       camera.height) +
           matrix_text("camera_matrix", 3, matrix_of(camera.intrinsics), true) +
           fmt::format("distortion_model: {}\nfisheye_model: {}\n", model_of(d),
                       d.model == DistortionDesc::Model::fisheye ? 1 : 0) +
           matrix_text("distortion_coefficients", coefficients.size(), coefficients, true);
}

std::string write_ros(const CameraDesc& camera) {
    const std::vector<double> coefficients = coefficients_of(camera.distortion);
    const std::array<double, 9> m = matrix_of(camera.intrinsics);
    constexpr std::array<double, 9> k_identity{1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::array<double, 12> projection{m[0], 0, m[2], 0, 0, m[4], m[5], 0, 0, 0, 1, 0};
    return fmt::format("image_width: {}\nimage_height: {}\ncamera_name: camera\n", camera.width,
                       camera.height) +
           matrix_text("camera_matrix", 3, m, false) +
           fmt::format("distortion_model: {}\n", model_of(camera.distortion)) +
           matrix_text("distortion_coefficients", 1, coefficients, false) +
           matrix_text("rectification_matrix", 3, k_identity, false) +
           matrix_text("projection_matrix", 3, projection, false);
}

// Kalibr's camchain.yaml: a map cam0, cam1, ... First pixel's centre at (0, 0).

namespace {

constexpr auto k_intrinsics_mend = "give [fu, fv, pu, pv] in pixels";

void check_projection(const ConfigValue& value) {
    const std::string name = value.text("give the camera model, such as pinhole");
    if (name == "pinhole") return;
    if (name == "omni" || name == "ds" || name == "eucm") {
        value.fail(fmt::format(
            "the camera model {} is not supported; calibrate with --models pinhole-equi (fisheye) "
            "or pinhole-radtan instead",
            name));
    }
    value.fail(fmt::format("unknown camera model '{}'; use pinhole", printable(name)));
}

void read_lens(const ConfigValue& camera, Calibration& result) {
    const ConfigValue model =
        require_value(camera, "distortion_model", "give radtan, equidistant or none");
    enum class KalibrModel : std::uint8_t { radtan, equidistant, none, fov };
    constexpr std::array<std::pair<std::string_view, KalibrModel>, 4> k_models{
        {{"radtan", KalibrModel::radtan},
         {"equidistant", KalibrModel::equidistant},
         {"none", KalibrModel::none},
         {"fov", KalibrModel::fov}}};
    const KalibrModel which = model.choice(k_models);
    if (which == KalibrModel::fov)
        model.fail(
            "the distortion model fov is not supported; calibrate with radtan or equi instead");
    result.model = "pinhole, " + model.node().scalar;
    DistortionDesc& distortion = result.desc.distortion;
    if (which == KalibrModel::none) return;
    constexpr auto k_mend = "give the four numbers that go with the distortion model";
    const auto numbers = require_value(camera, "distortion_coeffs", k_mend).list_of(4, k_mend);
    std::array<double, 4> d{};
    for (std::size_t i = 0; i < 4; ++i) d[i] = numbers[i].number(k_mend);
    if (which == KalibrModel::equidistant) {
        distortion.model = DistortionDesc::Model::fisheye;
        distortion.k = {d[0], d[1], d[2], d[3], 0, 0};
        return;
    }
    distortion.k = {d[0], d[1], 0, 0, 0, 0};
    distortion.p = {d[2], d[3]};
}

}  // namespace

bool looks_like_kalibr(const ConfigNode& root) {
    for (const ConfigNode::Entry& entry : root.entries)
        if (entry.value.find("camera_model") != nullptr) return true;
    return false;
}

Calibration read_kalibr(const ConfigValue& root, const std::string& camera) {
    Calibration result;
    result.format = CalibrationFormat::kalibr;
    for (const ConfigNode::Entry& entry : root.node().entries)
        if (entry.value.find("camera_model") != nullptr) result.cameras.push_back(entry.key);
    result.camera = choose_camera(result.cameras, camera, root.location());
    const ConfigValue chosen(*root.node().find(result.camera), printable(result.camera));
    check_projection(require_value(chosen, "camera_model", "give pinhole"));
    read_lens(chosen, result);

    const auto numbers =
        require_value(chosen, "intrinsics", k_intrinsics_mend).list_of(4, k_intrinsics_mend);
    result.desc.intrinsics = {numbers[0].positive(k_intrinsics_mend),
                              numbers[1].positive(k_intrinsics_mend),
                              numbers[2].number(k_intrinsics_mend) + k_half_pixel,
                              numbers[3].number(k_intrinsics_mend) + k_half_pixel};
    const ConfigValue resolution =
        require_value(chosen, "resolution", "give [width, height] in pixels");
    const auto sides = resolution.list_of(2, "give [width, height] in pixels");
    read_resolution(resolution, sides[0], sides[1], result.desc);
    return result;
}

std::string kalibr_obstacle(const CameraDesc& camera) {
    if (camera.port) return "Kalibr's files have no ports; write calibmar or colmap";
    const DistortionDesc& d = camera.distortion;
    if (d.model == DistortionDesc::Model::brown_conrady && has_radial_above(d, 2))
        return "Kalibr's radtan has only k1, k2, p1 and p2, and this camera has more; write "
               "opencv, ros, calibmar or colmap";
    return "";
}

std::string write_kalibr(const CameraDesc& camera) {
    const DistortionDesc& d = camera.distortion;
    const bool fisheye = d.model == DistortionDesc::Model::fisheye;
    const std::array<double, 4> coefficients =
        fisheye ? std::array<double, 4>{d.k[0], d.k[1], d.k[2], d.k[3]}
                : std::array<double, 4>{d.k[0], d.k[1], d.p[0], d.p[1]};
    const IntrinsicsDesc& i = camera.intrinsics;
    const std::array<double, 4> intrinsics{i.fx, i.fy, i.cx - k_half_pixel, i.cy - k_half_pixel};
    return fmt::format(
        "cam0:\n  camera_model: pinhole\n  intrinsics: {}\n  distortion_model: {}\n"
        "  distortion_coeffs: {}\n  resolution: [{}, {}]\n  rostopic: /cam0/image_raw\n",
        number_list(intrinsics), fisheye ? "equidistant" : "radtan", number_list(coefficients),
        camera.width, camera.height);
}

// The camera section of a scene file, ready to paste.

namespace {

std::string glass(double thickness, const auto& port) {
    const auto index = [](double number, const std::optional<DispersionDesc>& material) {
        return material ? scene_text(*material) : fmt::format("{}", number);
    };
    return fmt::format(
        "thickness: {}, n_air: {}, n_glass: {}, n_water: {}{}{}", thickness,
        index(port.n_air, port.dispersion.air), index(port.n_glass, port.dispersion.glass),
        index(port.n_water, port.dispersion.water), port.fresnel ? ", fresnel: true" : "",
        port.radiance_in_air ? ", radiance_in: air" : "");
}

std::string port_text(const PortDesc& port) {
    if (const auto* dome = std::get_if<DomePortDesc>(&port)) {
        const std::array<double, 3> center{dome->center.x, dome->center.y, dome->center.z};
        return fmt::format("  port: {{type: dome, center: {}, radius: {}, {}}}\n",
                           number_list(center), dome->radius, glass(dome->thickness, *dome));
    }
    const auto& flat = std::get<FlatPortDesc>(port);
    const std::array<double, 3> normal{flat.normal.x, flat.normal.y, flat.normal.z};
    return fmt::format("  port: {{type: flat, normal: {}, distance: {}, {}}}\n",
                       number_list(normal), flat.distance, glass(flat.thickness, flat));
}

}  // namespace

std::string write_scene_camera(const CameraDesc& camera) {
    const IntrinsicsDesc& i = camera.intrinsics;
    std::string text = fmt::format(
        "camera:\n  resolution: [{}, {}]\n  intrinsics: {{fx: {}, fy: {}, cx: {}, cy: {}}}\n",
        camera.width, camera.height, i.fx, i.fy, i.cx, i.cy);
    const DistortionDesc& d = camera.distortion;
    if (d.model == DistortionDesc::Model::fisheye) {
        text += fmt::format("  distortion: {{model: fisheye, k: {}}}\n",
                            number_list(std::span(d.k).first(4)));
    } else if (is_distorted(d)) {
        const std::size_t count = has_radial_above(d, 3) ? 6 : 3;
        text += fmt::format("  distortion: {{model: brown-conrady, k: {}, p: {}}}\n",
                            number_list(std::span(d.k).first(count)), number_list(d.p));
    }
    if (camera.port) text += port_text(*camera.port);
    return text;
}

}  // namespace uw
