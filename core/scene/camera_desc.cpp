#include "core/scene/camera_desc.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "core/base/error.h"
#include "core/scene/config_value.h"
#include "core/scene/scene_context.h"
#include "core/scene/sensor_desc.h"
#include "core/scene/trajectory_reader.h"

namespace uw {

namespace {

double read_length(const ConfigValue& value, const SceneContext& context) {
    const double length = value.non_negative("give a length in metres");
    if (length > 1) {
        context.warn(value,
                     fmt::format("{} m is very large for a port; lengths are in metres", length));
    }
    return length;
}

/// The keys that flat and dome ports share.
template <class PortDescription>
void read_glass(ConfigMap& map, const SceneContext& context, PortDescription& port) {
    if (const auto entry = map.find("thickness")) port.thickness = read_length(*entry, context);
    if (const auto entry = map.find("n_air")) port.dispersion.air = read_index(*entry, port.n_air);
    if (const auto entry = map.find("n_glass"))
        port.dispersion.glass = read_index(*entry, port.n_glass);
    if (const auto entry = map.find("n_water"))
        port.dispersion.water = read_index(*entry, port.n_water);
    if (const auto fresnel = map.find("fresnel")) {
        constexpr std::array<std::pair<std::string_view, bool>, 2> k_switch{
            {{"true", true}, {"false", false}}};
        port.fresnel = fresnel->choice(k_switch);
    }
    if (const auto medium = map.find("radiance_in")) {
        constexpr std::array<std::pair<std::string_view, bool>, 2> k_media{
            {{"water", false}, {"air", true}}};
        port.radiance_in_air = medium->choice(k_media);
    }
}

FlatPortDesc read_flat(ConfigMap& map, const SceneContext& context) {
    FlatPortDesc port;
    if (const auto normal = map.find("normal")) {
        port.normal =
            normal->direction("give the glass's normal in camera axes, towards the water");
        check_port_normal(*normal, port.normal);
    }
    if (const auto entry = map.find("distance")) port.distance = read_length(*entry, context);
    read_glass(map, context, port);
    map.finish("type 'flat'");
    return port;
}

DomePortDesc read_dome(ConfigMap& map, const SceneContext& context) {
    DomePortDesc port;
    if (const auto center = map.find("center"))
        port.center = at_origin_plus(center->vector("give the dome's centre in camera axes"));
    const ConfigValue radius =
        map.require("radius", "give the radius of the inner glass surface in metres");
    radius.positive("give the radius of the inner glass surface in metres");
    port.radius = read_length(radius, context);
    read_glass(map, context, port);
    map.finish("type 'dome'");
    check_dome(map.value(), port);
    return port;
}

}  // namespace

bool disperses(const CameraDesc& camera) {
    return camera.port &&
           std::visit([](const auto& port) { return port.dispersion.any(); }, *camera.port);
}

void set_wavelength(CameraDesc& camera, double wavelength_nm) {
    camera.wavelength_nm = wavelength_nm;
    if (!camera.port) return;
    const auto update = [&](const std::optional<DispersionDesc>& material, double& index) {
        if (material) index = refractive_index(*material, wavelength_nm);
    };
    std::visit(
        [&](auto& port) {
            update(port.dispersion.air, port.n_air);
            update(port.dispersion.glass, port.n_glass);
            update(port.dispersion.water, port.n_water);
        },
        *camera.port);
}

double reference_wavelength(std::span<const double> bands_nm) {
    constexpr double k_wanted_nm = 550;
    return *std::ranges::min_element(bands_nm, {},
                                     [](double nm) { return std::abs(nm - k_wanted_nm); });
}

void read_resolution(const ConfigValue& both, const ConfigValue& width, const ConfigValue& height,
                     CameraDesc& camera) {
    constexpr auto k_hint = "give [width, height] in pixels";
    camera.width = width.integer(1, k_longest_image_side, k_hint);
    camera.height = height.integer(1, k_longest_image_side, k_hint);
    if (const std::string fault = too_many_pixels(camera.width, camera.height); !fault.empty())
        both.fail(fault);
}

std::string too_many_pixels(int width, int height) {
    constexpr long long k_max_pixels = 1LL << 28;
    if (static_cast<long long>(width) * height <= k_max_pixels) return "";
    return fmt::format("{} x {} are more than {} pixels; give a smaller image", width, height,
                       k_max_pixels);
}

double read_refractive_index(const ConfigValue& value) {
    return value.within(1, 3, "give a refractive index, such as 1.0, 1.49 or 1.334");
}

void check_port_normal(const ConfigValue& at, const Vector3& normal) {
    if (normal.z > 0) return;
    at.fail(
        "must point away from the camera (z > 0), found z <= 0; camera axes are x right, y down, "
        "z forward");
}

void check_dome(const ConfigValue& at, const DomePortDesc& dome) {
    const double offset = glm::length(from_origin(dome.center));
    if (offset < dome.radius) return;
    at.fail(
        fmt::format("the camera is outside its dome: it is {} m from the centre, but the inner "
                    "radius is {} m; give lengths in metres and the centre in camera axes",
                    offset, dome.radius));
}

PortDesc read_port(const ConfigValue& value, const SceneContext& context) {
    ConfigMap map(value,
                  {"type", "normal", "distance", "thickness", "n_air", "n_glass", "n_water",
                   "fresnel", "radiance_in", "center", "radius"},
                  "write {type: flat, distance: 0.02, thickness: 0.01}");
    enum class Type { flat, dome };
    constexpr std::array<std::pair<std::string_view, Type>, 2> k_types{
        {{"flat", Type::flat}, {"dome", Type::dome}}};
    Type type = Type::flat;
    if (const auto entry = map.find("type")) type = entry->choice(k_types);
    if (type == Type::dome) return read_dome(map, context);
    return read_flat(map, context);
}

namespace {

/// Image radius at which a fisheye shows the angle `theta` [rad], in units of the focal length.
double fisheye_radius(double theta, const DistortionDesc& distortion) {
    double sum = 0;
    for (std::size_t i = 4; i-- > 0;) sum = (sum + distortion.k[i]) * theta * theta;
    return theta * (1 + sum);
}

/// Whether the image radius grows monotonically for all angles up to `theta`.
bool grows_to(double theta, const DistortionDesc& distortion) {
    constexpr int k_steps = 1000;
    double last = 0;
    for (int i = 1; i <= k_steps; ++i) {
        const double here = fisheye_radius(theta * i / k_steps, distortion);
        if (!(here > last)) return false;
        last = here;
    }
    return true;
}

IntrinsicsDesc read_intrinsics(const ConfigValue& value, const CameraDesc& camera,
                               const SceneContext& context) {
    ConfigMap map(value, {"fx", "fy", "cx", "cy", "fov_x"}, "write {fov_x: 60} or {fx: 1400}");
    IntrinsicsDesc intrinsics;
    intrinsics.cx = camera.width / 2.0;
    intrinsics.cy = camera.height / 2.0;
    if (const auto fov = map.find("fov_x")) {
        map.finish("intrinsics with 'fov_x'");
        constexpr auto k_hint = "give the horizontal field of view in degrees";
        const bool fisheye = camera.distortion.model == DistortionDesc::Model::fisheye;
        const double degrees =
            fisheye ? fov->within(1e-3, 360, k_hint) : fov->between(0, 180, k_hint);
        if (degrees <= std::numbers::pi)
            context.warn(*fov, fmt::format("{} degrees is a very narrow view; degrees, not radians "
                                           "({} radians are {:.3g} degrees)?",
                                           degrees, degrees, degrees * 180 / std::numbers::pi));
        const double half = degrees / 2 * std::numbers::pi / 180;
        const double edge = fisheye ? fisheye_radius(half, camera.distortion) : std::tan(half);
        if (fisheye && !grows_to(half, camera.distortion)) {
            fov->fail(
                fmt::format("the distortion folds back before {} degrees off the axis; check "
                            "distortion.k, or give fx in pixels",
                            degrees / 2));
        }
        intrinsics.fx = intrinsics.fy = camera.width / 2.0 / edge;
        return intrinsics;
    }
    constexpr auto k_focal = "give the focal length in pixels";
    constexpr auto k_centre = "give the principal point in pixels";
    intrinsics.fx = map.require("fx", "give fx in pixels, or fov_x in degrees").positive(k_focal);
    intrinsics.fy = intrinsics.fx;
    if (const auto fy = map.find("fy")) intrinsics.fy = fy->positive(k_focal);
    if (const auto cx = map.find("cx")) intrinsics.cx = cx->number(k_centre);
    if (const auto cy = map.find("cy")) intrinsics.cy = cy->number(k_centre);
    return intrinsics;
}

/// Reads numbers into the leading elements of `places`.
void read_coefficients(const ConfigValue& value, std::size_t least, std::string_view hint,
                       std::span<double> places) {
    const std::vector<ConfigValue> numbers = value.list(hint);
    if (numbers.size() < least || numbers.size() > places.size()) {
        const std::string count = least == places.size()
                                      ? fmt::format("{}", least)
                                      : fmt::format("{} to {}", least, places.size());
        value.fail(fmt::format("expected {} numbers, found {}; {}", count, numbers.size(), hint));
    }
    for (std::size_t i = 0; i < numbers.size(); ++i) places[i] = numbers[i].number(hint);
}

DistortionDesc read_distortion(const ConfigValue& value) {
    ConfigMap map(value, {"model", "k", "p", "k1", "k2", "k3", "k4"},
                  "write {model: brown-conrady, k: [0, 0, 0], p: [0, 0]}");
    using Model = DistortionDesc::Model;
    constexpr std::array<std::pair<std::string_view, Model>, 2> k_models{
        {{"brown-conrady", Model::brown_conrady}, {"fisheye", Model::fisheye}}};
    DistortionDesc distortion;
    if (const auto model = map.find("model")) distortion.model = model->choice(k_models);
    const auto k = map.find("k");
    if (distortion.model == Model::fisheye) {
        constexpr auto k_hint = "give k1, k2, k3, k4";
        if (k) read_coefficients(*k, 4, k_hint, std::span(distortion.k).first(4));
        constexpr std::array<std::string_view, 4> k_names{"k1", "k2", "k3", "k4"};
        for (std::size_t i = 0; i < k_names.size() && !k; ++i)
            if (const auto entry = map.find(k_names[i])) distortion.k[i] = entry->number(k_hint);
        map.finish("model 'fisheye' (write k: [k1, k2, k3, k4])");
        return distortion;
    }
    if (k) {
        read_coefficients(*k, 3, "give 3 to 6 numbers: k1, k2, k3 and, if rational, k4, k5, k6",
                          distortion.k);
    }
    if (const auto p = map.find("p")) {
        constexpr auto k_hint = "give two numbers: p1, p2";
        const std::vector<ConfigValue> numbers = p->list_of(2, k_hint);
        for (std::size_t i = 0; i < 2; ++i) distortion.p[i] = numbers[i].number(k_hint);
    }
    map.finish("model 'brown-conrady' (write k: [k1, k2, k3], p: [p1, p2])");
    return distortion;
}

LensDesc read_lens(const ConfigValue& value) {
    ConfigMap map(value, {"f_number", "focal_length", "transmission", "focus_distance"},
                  "write {f_number: 2.8, focal_length: 0.0085, transmission: 0.95}");
    LensDesc lens;
    const ConfigValue f_number = map.require("f_number", "give the f-number, such as 2.8");
    lens.f_number = f_number.positive("give the f-number, such as 2.8");
    const ConfigValue focal_length =
        map.require("focal_length", "give the focal length in metres, such as 0.0085");
    lens.focal_length = focal_length.positive("give the focal length in metres, such as 0.0085");
    if (lens.focal_length > 2) {
        focal_length.fail(fmt::format("{} looks like millimetres; give metres ({})",
                                      lens.focal_length, lens.focal_length / 1000));
    }
    if (const auto transmission = map.find("transmission")) {
        lens.transmission =
            transmission->within(0, 1, "give the fraction of light the lens lets through");
    }
    if (const auto focus = map.find("focus_distance"))
        lens.focus_distance = focus->positive("give metres from the camera along its axis");
    return lens;
}

double read_line_time(const ConfigValue& value) {
    constexpr double k_longest = 0.01;
    const double seconds = value.non_negative("give seconds from row to row, such as 15e-6");
    if (seconds > k_longest)
        value.fail(
            fmt::format("{} looks like microseconds, or like the readout of all rows; give "
                        "seconds from row to row, such as 15e-6",
                        seconds));
    return seconds;
}

/// A file name, or {file, camera}.
CalibrationDesc read_calibration_name(const ConfigValue& value, const SceneContext& context) {
    CalibrationDesc calibration;
    calibration.where = value.location();
    if (value.node().kind == ConfigNode::Kind::scalar) {
        calibration.file = read_existing_file(value, context);
        return calibration;
    }
    constexpr auto k_hint = "write calibration: rig.yaml, or {file: rig.yaml, camera: cam0}";
    ConfigMap map(value, {"file", "camera"}, k_hint);
    calibration.file = read_existing_file(map.require("file", k_hint), context);
    if (const auto camera = map.find("camera"))
        calibration.camera = camera->text("give the camera's name in the file, such as cam0");
    return calibration;
}

}  // namespace

CameraDesc read_camera(const ConfigValue& value, const SceneContext& context) {
    ConfigMap map(value,
                  {"resolution", "intrinsics", "distortion", "port", "pose", "trajectory", "lens",
                   "sensor", "line_time", "calibration"},
                  "write {resolution: [1920, 1080], intrinsics: {fov_x: 60}}");
    CameraDesc camera;
    if (const auto calibration = map.find("calibration")) {
        camera.calibration = read_calibration_name(*calibration, context);
        for (const std::string_view key : {"resolution", "intrinsics", "distortion"}) {
            if (const auto entry = map.find(key))
                entry->fail("comes from the calibration file; remove it here, or 'calibration'");
        }
    } else {
        const ConfigValue resolution =
            map.require("resolution", "give resolution: [width, height] in pixels");
        const auto sides = resolution.list_of(2, "give [width, height] in pixels");
        read_resolution(resolution, sides[0], sides[1], camera);
        const auto intrinsics = map.find("intrinsics");
        if (const auto entry = map.find("distortion")) camera.distortion = read_distortion(*entry);
        camera.has_intrinsics = intrinsics.has_value();
        if (intrinsics) camera.intrinsics = read_intrinsics(*intrinsics, camera, context);
    }
    camera.where = value.location();
    if (const auto entry = map.find("port")) camera.port = read_port(*entry, context);
    if (const auto entry = map.find("lens")) camera.lens = read_lens(*entry);
    if (const auto entry = map.find("sensor")) camera.sensor = read_sensor(*entry, context);
    if (const auto entry = map.find("line_time")) camera.line_time = read_line_time(*entry);
    const auto pose = map.find("pose");
    const auto trajectory = map.find("trajectory");
    camera.has_pose = pose || trajectory;
    if (pose) camera.world_from_camera = read_pose(*pose);
    if (trajectory) {
        if (pose)
            trajectory->fail(
                "a camera has either a pose or a trajectory; remove one (a camera with a pose in "
                "a moving body is a rig of one)");
        camera.trajectory = read_trajectory(*trajectory, context, true);
    }
    return camera;
}

namespace {

RigCameraDesc read_rig_camera(const ConfigValue& value, const SceneContext& context) {
    constexpr auto k_hint = "name the camera, such as left";
    const ConfigNode* const name = value.node().find("name");
    if (name == nullptr) value.fail(fmt::format("'name' is missing; {}", k_hint));
    RigCameraDesc camera;
    camera.name =
        read_short_name(ConfigValue(*name, value.path() + ".name"), "a file's name", k_hint);
    // The rest is a camera like that of a single-camera scene.
    ConfigNode unnamed = value.node();
    std::erase_if(unnamed.entries, [](const auto& entry) { return entry.key == "name"; });
    camera.camera = read_camera(ConfigValue(unnamed, value.path()), context);
    if (const auto& trajectory = camera.camera.trajectory)
        throw InputError(
            fmt::format("{}: the cameras of a rig are fixed to it; give rig: {{trajectory: ...}}",
                        trajectory->where));
    return camera;
}

}  // namespace

std::vector<RigCameraDesc> read_cameras(const ConfigValue& value,
                                        const std::optional<ConfigValue>& rig,
                                        SceneContext& context) {
    Affine world_from_rig;
    if (rig) {
        constexpr auto k_hint = "write rig: {pose: {position: [0, 0, 0], look_at: [0, 0, 1]}}";
        ConfigMap map(*rig, {"pose", "trajectory"}, k_hint);
        if (const auto trajectory = map.find("trajectory")) {
            map.finish("a rig with a trajectory");
            context.rig_trajectory = read_trajectory(*trajectory, context, true);
        } else {
            world_from_rig = read_pose(map.require("pose", k_hint));
        }
    }
    std::vector<RigCameraDesc> cameras;
    for (const ConfigValue& entry : value.list("write one '- {name: left, ...}' per camera")) {
        RigCameraDesc camera = read_rig_camera(entry, context);
        if (std::ranges::find(cameras, camera.name, &RigCameraDesc::name) != cameras.end())
            entry.fail(fmt::format("the name '{}' is taken by another camera; give each its own",
                                   camera.name));
        camera.camera.world_from_camera = world_from_rig * camera.camera.world_from_camera;
        cameras.push_back(std::move(camera));
    }
    if (cameras.empty()) value.fail("is empty; write one '- {name: left, ...}' per camera");
    context.rig = {world_from_rig, cameras.front().camera.world_from_camera};
    return cameras;
}

}  // namespace uw
