#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "camera/calibration.h"
#include "core/base/text.h"
#include "core/scene/camera_desc.h"

namespace uw {

// Functions common to several formats.

std::vector<ConfigValue> matrix_numbers(const ConfigValue& value, std::string_view hint) {
    if (value.node().kind != ConfigNode::Kind::map) return value.list(hint);
    std::vector<ConfigValue> numbers = require_value(value, "data", hint).list(hint);
    const ConfigNode* const rows = value.node().find("rows");
    const ConfigNode* const cols = value.node().find("cols");
    if (rows == nullptr || cols == nullptr) return numbers;
    constexpr int k_max_rows = 64;
    const int count = ConfigValue(*rows, value.path() + ".rows").integer(0, k_max_rows, hint) *
                      ConfigValue(*cols, value.path() + ".cols").integer(0, k_max_rows, hint);
    if (static_cast<std::size_t>(count) != numbers.size())
        value.fail(fmt::format("rows x cols is {}, but data has {} numbers; {}", count,
                               numbers.size(), hint));
    return numbers;
}

IntrinsicsDesc intrinsics_from_zero(std::span<const ConfigValue> fx_fy_cx_cy,
                                    std::string_view hint) {
    return {fx_fy_cx_cy[0].positive(hint), fx_fy_cx_cy[1].positive(hint),
            fx_fy_cx_cy[2].number(hint) + k_half_pixel, fx_fy_cx_cy[3].number(hint) + k_half_pixel};
}

DistortionDesc opencv_lens(std::span<const double> coefficients) {
    std::array<double, 8> d{};
    std::ranges::copy(coefficients, d.begin());
    DistortionDesc lens;
    lens.k = {d[0], d[1], d[4], d[5], d[6], d[7]};
    lens.p = {d[2], d[3]};
    return lens;
}

DistortionDesc fisheye_lens(std::span<const double> coefficients) {
    DistortionDesc lens;
    lens.model = DistortionDesc::Model::fisheye;
    std::ranges::copy(coefficients, lens.k.begin());
    return lens;
}

// The YAML of OpenCV's FileStorage, as its calibration sample writes it, and of ROS camera_info.
// First pixel's centre at (0, 0).

namespace {

using Names = std::span<const std::string_view>;
// Those of a message of ROS's camera_info are K, D, width and height, in ROS 2 k and d.
constexpr std::array<std::string_view, 5> k_matrix_names{"camera_matrix", "Camera_Matrix",
                                                         "cameraMatrix", "K", "k"};
constexpr std::array<std::string_view, 5> k_coefficient_names{
    "distortion_coefficients", "Distortion_Coefficients", "distCoeffs", "D", "d"};
constexpr std::array<std::string_view, 3> k_width_names{"image_width", "image_Width", "width"};
constexpr std::array<std::string_view, 3> k_height_names{"image_height", "image_Height", "height"};

/// Whether the document is a message of ROS's camera_info, as `ros2 topic echo` prints it.
bool is_camera_info(const ConfigNode& root) {
    return root.find("width") != nullptr && root.find("height") != nullptr &&
           (root.find("K") != nullptr || root.find("k") != nullptr);
}

const ConfigNode* find_any(const ConfigNode& map, Names names) {
    for (const std::string_view name : names)
        if (const ConfigNode* const node = map.find(name)) return node;
    return nullptr;
}

/// The value of the first of several keys that is present.
ConfigValue require_any(const ConfigValue& map, Names names, std::string_view hint) {
    for (const std::string_view name : names)
        if (const ConfigNode* const node = map.node().find(name)) return {*node, std::string(name)};
    return require_value(map, names.front(), hint);
}

void read_matrix(const ConfigValue& value, IntrinsicsDesc& intrinsics) {
    constexpr auto k_hint = "give the nine numbers fx 0 cx 0 fy cy 0 0 1";
    const auto m = matrix_numbers(value, k_hint);
    if (m.size() != 9)
        value.fail(fmt::format("expected 9 numbers, found {}; {}", m.size(), k_hint));
    if (m[0].number(k_hint) == 0 && m[4].number(k_hint) == 0)
        value.fail(
            "is that of a camera which is not calibrated, with a focal length of 0; calibrate "
            "it, or take the message of another");
    constexpr std::array<double, 9> k_fixed{-1, 0, -1, 0, -1, -1, 0, 0, 1};
    for (std::size_t i = 0; i < 9; ++i) {
        if (k_fixed[i] >= 0 && m[i].number(k_hint) != k_fixed[i])
            m[i].fail(fmt::format("must be {}, found {}: skewed pixels are not supported; {}",
                                  k_fixed[i], m[i].number(k_hint), k_hint));
    }
    intrinsics = intrinsics_from_zero(std::array{m[0], m[4], m[2], m[5]}, k_hint);
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
        // Drivers of cameras without distortion leave the name and the coefficients out.
        if (node->scalar.empty()) {
            result.model = "none";
            return Model::plumb_bob;
        }
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
    constexpr auto k_hint = "give k1 k2 p1 p2 [k3 [k4 k5 k6]], or k1 k2 k3 k4 of a fisheye";
    std::vector<double> d;
    for (const ConfigValue& number : matrix_numbers(value, k_hint))
        d.push_back(number.number(k_hint));
    const std::size_t count = d.size();
    const auto refuse = [&](std::string_view expected) {
        value.fail(fmt::format("expected {} numbers, found {}; {}", expected, count, k_hint));
    };
    // Programs write zeros for coefficients that a model does not have.
    const auto refuse_beyond = [&](std::size_t last, std::string_view what, std::string_view hint) {
        for (std::size_t i = last; i < count; ++i)
            if (d[i] != 0)
                value.fail(fmt::format("has {} ({}), which is not supported; {}",
                                       i >= 12  ? "a sensor tilt"
                                       : i >= 8 ? "a thin-prism coefficient"
                                                : what,
                                       d[i], hint));
    };
    constexpr std::size_t k_max_coefficients = 14;
    if (count > k_max_coefficients) refuse("0, 4, 5, 8, 12 or 14");
    if (model == Model::equidistant) {
        if (count < 4) refuse("4");
        refuse_beyond(4, "a coefficient beyond k1 to k4", "calibrate with these four");
        result.desc.distortion = fisheye_lens(std::span(d).first(4));
        return;
    }
    const bool is_plumb_bob = model == Model::plumb_bob;
    if (is_plumb_bob && count != 0 && count < 4) refuse("4 or 5");
    if (model == Model::rational && count < 8) refuse("8");
    if (!is_plumb_bob && model != Model::rational && count != 0 && count != 4 && count != 5 &&
        count != 8 && count != 12 && count != k_max_coefficients)
        refuse("0, 4, 5, 8, 12 or 14");
    if (is_plumb_bob)
        refuse_beyond(5, "a sixth coefficient or more",
                      "write distortion_model: rational_polynomial if it is of that model");
    refuse_beyond(8, "", "calibrate without that model");
    result.desc.distortion = opencv_lens(std::span(d).first(std::min<std::size_t>(count, 8)));
    if (count >= 8 && !is_plumb_bob) result.model = "rational_polynomial";
    if (model == Model::unnamed && count == 4)
        result.warnings.push_back(value.location() +
                                  ": the file names no distortion_model, so the four numbers are "
                                  "taken as k1 k2 p1 p2, as from cv::calibrateCamera; if they come "
                                  "from cv::fisheye, add distortion_model: equidistant");
}

/// Takes the image to the part of the sensor that a camera_info says was read out, and to fewer
/// pixels where several were binned, as PinholeCameraModel::fromCameraInfo of ROS's image_geometry
/// does.
void read_window(const ConfigValue& root, Calibration& result) {
    constexpr auto k_hint = "give whole pixels, or 0 for none";
    constexpr int k_max_binned = 1000;
    CameraDesc& camera = result.desc;
    const auto pixels = [&](const ConfigValue& map, std::string_view key, int most) {
        const ConfigNode* const node = map.node().find(key);
        const std::string path =
            map.path().empty() ? std::string(key) : fmt::format("{}.{}", map.path(), key);
        return node == nullptr ? 0 : ConfigValue(*node, path).integer(0, most, k_hint);
    };
    int width = camera.width, height = camera.height;
    if (const ConfigNode* const node = root.node().find("roi")) {
        const ConfigValue roi(*node, "roi");
        const int x = pixels(roi, "x_offset", width), y = pixels(roi, "y_offset", height);
        const int wide = pixels(roi, "width", width), high = pixels(roi, "height", height);
        const bool is_whole = x == 0 && y == 0 && wide == 0 && high == 0;
        if (!is_whole && (wide == 0 || high == 0 || x + wide > width || y + high > height))
            roi.fail(
                fmt::format("{} x {} pixels at ({}, {}) are no part of the image of {} x {}; give "
                            "zeros for all "
                            "of it",
                            wide, high, x, y, width, height));
        if (!is_whole && (wide != width || high != height)) {
            result.model += fmt::format(", roi {} x {} at ({}, {})", wide, high, x, y);
            width = wide;
            height = high;
            camera.intrinsics.cx -= x;
            camera.intrinsics.cy -= y;
        }
    }
    const int across = std::max(1, pixels(root, "binning_x", k_max_binned));
    const int down = std::max(1, pixels(root, "binning_y", k_max_binned));
    if (across > 1 || down > 1) {
        result.model += fmt::format(", binning {} x {}", across, down);
        IntrinsicsDesc& i = camera.intrinsics;
        const auto binned = [](double c, int by) { return (c - k_half_pixel) / by + k_half_pixel; };
        i = {i.fx / across, i.fy / down, binned(i.cx, across), binned(i.cy, down)};
    }
    camera.width = width / across;
    camera.height = height / down;
    if (camera.width == 0 || camera.height == 0)
        root.fail(
            "its binning leaves no pixel; give binning_x and binning_y as the driver has them");
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
    const auto has_any = [&](Names names) {
        return find_any(root, names.first(names.size() - 1)) != nullptr;  // "k" and "d" are words
    };
    return has_any(k_matrix_names) || has_any(k_coefficient_names) || is_camera_info(root) ||
           root.find("distortion_model") != nullptr;
}

Calibration read_opencv_yaml(const ConfigValue& root) {
    Calibration result;
    const bool is_ros = root.node().find("projection_matrix") != nullptr ||
                        root.node().find("camera_name") != nullptr || is_camera_info(root.node());
    result.format = is_ros ? CalibrationFormat::ros : CalibrationFormat::opencv;
    if (const ConfigNode* const name = root.node().find("camera_name"))
        result.camera = name->scalar;
    if (const ConfigNode* const header = root.node().find("header"))
        if (const ConfigNode* const frame = header->find("frame_id")) result.camera = frame->scalar;
    constexpr auto k_size = "give image_width and image_height in pixels";
    const ConfigValue width = require_any(root, k_width_names, k_size);
    read_resolution(width, width, require_any(root, k_height_names, k_size), result.desc);
    read_matrix(require_any(root, k_matrix_names, "give camera_matrix: {rows: 3, cols: 3, data}"),
                result.desc.intrinsics);
    const Model model = read_model(root, result);
    read_coefficients(
        require_any(root, k_coefficient_names, "give distortion_coefficients: {data: [...]}"),
        model, result);
    if (is_camera_info(root.node())) read_window(root, result);
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

constexpr auto k_intrinsics_hint = "give [fu, fv, pu, pv] in pixels";

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
    if (which == KalibrModel::none) return;
    constexpr auto k_hint = "give the four numbers that go with the distortion model";
    const auto numbers = require_value(camera, "distortion_coeffs", k_hint).list_of(4, k_hint);
    std::array<double, 4> d{};
    for (std::size_t i = 0; i < 4; ++i) d[i] = numbers[i].number(k_hint);
    result.desc.distortion = which == KalibrModel::equidistant ? fisheye_lens(d) : opencv_lens(d);
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
        require_value(chosen, "intrinsics", k_intrinsics_hint).list_of(4, k_intrinsics_hint);
    result.desc.intrinsics = intrinsics_from_zero(numbers, k_intrinsics_hint);
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

namespace {

/// A camera of a chain; `poses` are its lines of poses.
std::string kalibr_camera(const CameraDesc& camera, std::size_t number, const std::string& poses) {
    const DistortionDesc& d = camera.distortion;
    const bool fisheye = d.model == DistortionDesc::Model::fisheye;
    const std::array<double, 4> coefficients =
        fisheye ? std::array<double, 4>{d.k[0], d.k[1], d.k[2], d.k[3]}
                : std::array<double, 4>{d.k[0], d.k[1], d.p[0], d.p[1]};
    const IntrinsicsDesc& i = camera.intrinsics;
    const std::array<double, 4> intrinsics{i.fx, i.fy, i.cx - k_half_pixel, i.cy - k_half_pixel};
    return fmt::format(
        "cam{0}:\n{1}  camera_model: pinhole\n  intrinsics: {2}\n  distortion_model: {3}\n"
        "  distortion_coeffs: {4}\n  resolution: [{5}, {6}]\n  rostopic: /cam{0}/image_raw\n",
        number, poses, number_list(intrinsics), fisheye ? "equidistant" : "radtan",
        number_list(coefficients), camera.width, camera.height);
}

/// The rows of a rigid map as Kalibr has them.
std::string kalibr_pose(const char* name, const Affine& map) {
    std::string text = fmt::format("  {}:\n", name);
    for (int row = 0; row < 3; ++row)
        // + 0.0 makes 0 of -0.
        text += fmt::format("  - [{}, {}, {}, {}]\n", map.linear()[0][row] + 0.0,
                            map.linear()[1][row] + 0.0, map.linear()[2][row] + 0.0,
                            map.offset()[row] + 0.0);
    return text + "  - [0.0, 0.0, 0.0, 1.0]\n";
}

}  // namespace

std::string write_kalibr(const CameraDesc& camera) {
    return kalibr_camera(camera, 0, "");
}

std::string write_kalibr_chain(std::span<const ChainedCamera> cameras) {
    std::string text;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        const Affine& own = cameras[i].camera_from_imu;
        std::string poses = kalibr_pose("T_cam_imu", own);
        if (i > 0)
            poses += kalibr_pose("T_cn_cnm1", own * cameras[i - 1].camera_from_imu.inverse());
        text += kalibr_camera(cameras[i].desc, i, poses + "  timeshift_cam_imu: 0.0\n");
    }
    return text;
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
