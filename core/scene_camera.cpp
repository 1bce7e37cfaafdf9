#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/config_map.h"
#include "core/scene_sections.h"

namespace uw {
namespace {

constexpr int k_longest_side = 32768;
constexpr long long k_most_pixels = 1LL << 28;

void read_resolution(const ConfigValue& value, CameraDesc& camera) {
    constexpr auto k_mend = "give [width, height] in pixels";
    const std::vector<ConfigValue> sides = value.list_of(2, k_mend);
    camera.width = sides[0].integer(1, k_longest_side, k_mend);
    camera.height = sides[1].integer(1, k_longest_side, k_mend);
    const long long pixels = static_cast<long long>(camera.width) * camera.height;
    if (pixels > k_most_pixels) {
        value.fail(fmt::format("{} x {} are more than {} pixels; give a smaller image",
                               camera.width, camera.height, k_most_pixels));
    }
}

IntrinsicsDesc read_intrinsics(const ConfigValue& value, const CameraDesc& camera) {
    ConfigMap map(value, {"fx", "fy", "cx", "cy", "fov_x"}, "write {fov_x: 60} or {fx: 1400}");
    IntrinsicsDesc intrinsics;
    intrinsics.cx = camera.width / 2.0;
    intrinsics.cy = camera.height / 2.0;
    if (const auto fov = map.find("fov_x")) {
        map.finish("intrinsics with 'fov_x'");
        const double degrees = fov->between(0, 180, "give the horizontal field of view in degrees");
        const double half = degrees / 2 * std::numbers::pi / 180;
        intrinsics.fx = intrinsics.fy = camera.width / 2.0 / std::tan(half);
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

DistortionDesc read_distortion(const ConfigValue& value) {
    ConfigMap map(value, {"model", "k", "p", "k1", "k2", "k3", "k4"},
                  "write {model: brown-conrady, k: [0, 0, 0], p: [0, 0]}");
    enum class Model { brown_conrady, fisheye };
    constexpr std::array<std::pair<std::string_view, Model>, 2> k_models{
        {{"brown-conrady", Model::brown_conrady}, {"fisheye", Model::fisheye}}};
    if (const auto model = map.find("model")) {
        if (model->choice(k_models) == Model::fisheye) {
            model->fail("'fisheye' is not supported yet; use brown-conrady");
        }
    }
    DistortionDesc distortion;
    if (const auto k = map.find("k")) {
        constexpr auto k_mend = "give 3 to 6 numbers: k1, k2, k3 and, if rational, k4, k5, k6";
        const std::vector<ConfigValue> numbers = k->list(k_mend);
        if (numbers.size() < 3 || numbers.size() > distortion.k.size()) {
            k->fail(fmt::format("expected 3 to 6 numbers, found {}; {}", numbers.size(), k_mend));
        }
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            distortion.k[i] = numbers[i].number(k_mend);
        }
    }
    if (const auto p = map.find("p")) {
        constexpr auto k_mend = "give two numbers: p1, p2";
        const std::vector<ConfigValue> numbers = p->list_of(2, k_mend);
        for (std::size_t i = 0; i < 2; ++i) distortion.p[i] = numbers[i].number(k_mend);
    }
    map.finish("model 'brown-conrady' (write k: [k1, k2, k3], p: [p1, p2])");
    return distortion;
}

LensDesc read_lens(const ConfigValue& value) {
    ConfigMap map(value, {"f_number", "focal_length", "transmission"},
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
    return lens;
}

FlatPortDesc read_port(const ConfigValue& value, const SceneContext& context) {
    ConfigMap map(value,
                  {"type", "normal", "distance", "thickness", "n_air", "n_glass", "n_water",
                   "fresnel", "radiance_in", "center", "radius"},
                  "write {type: flat, distance: 0.02, thickness: 0.01}");
    enum class Type { flat, dome };
    constexpr std::array<std::pair<std::string_view, Type>, 2> k_types{
        {{"flat", Type::flat}, {"dome", Type::dome}}};
    if (const auto type = map.find("type")) {
        if (type->choice(k_types) == Type::dome) {
            type->fail("'dome' is not supported yet; use a flat port, or none");
        }
    }
    FlatPortDesc port;
    if (const auto normal = map.find("normal")) {
        port.normal =
            normal->direction("give the glass's normal in camera axes, towards the water");
        if (port.normal.z <= 0) {
            normal->fail(
                "must point away from the camera (z > 0), found z <= 0; camera axes are x "
                "right, y down, z forward");
        }
    }
    const auto read_length = [&](std::string_view key, double& length) {
        const auto entry = map.find(key);
        if (!entry) return;
        length = entry->non_negative("give a length in metres");
        if (length > 1) {
            context.warn(*entry,
                         fmt::format("{} m is a lot for a port; lengths are in metres", length));
        }
    };
    read_length("distance", port.distance);
    read_length("thickness", port.thickness);
    const auto read_index = [&](std::string_view key, double& index) {
        if (const auto entry = map.find(key)) {
            index = entry->within(1, 3, "give a refractive index, such as 1.0, 1.49 or 1.334");
        }
    };
    read_index("n_air", port.n_air);
    read_index("n_glass", port.n_glass);
    read_index("n_water", port.n_water);
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
    map.finish("type 'flat'");
    return port;
}

}  // namespace

CameraDesc read_camera(const ConfigValue& value, const SceneContext& context) {
    ConfigMap map(value,
                  {"resolution", "intrinsics", "distortion", "port", "pose", "lens", "calibration"},
                  "write {resolution: [1920, 1080], intrinsics: {fov_x: 60}}");
    if (const auto calibration = map.find("calibration")) {
        calibration->fail(
            "calibration files are not supported yet; write their numbers as "
            "intrinsics, distortion and port");
    }
    CameraDesc camera;
    read_resolution(map.require("resolution", "give resolution: [width, height] in pixels"),
                    camera);
    camera.where = value.location();
    const auto intrinsics = map.find("intrinsics");
    camera.has_intrinsics = intrinsics.has_value();
    if (intrinsics) camera.intrinsics = read_intrinsics(*intrinsics, camera);
    if (const auto entry = map.find("distortion")) camera.distortion = read_distortion(*entry);
    if (const auto entry = map.find("port")) camera.port = read_port(*entry, context);
    if (const auto entry = map.find("lens")) camera.lens = read_lens(*entry);
    const auto pose = map.find("pose");
    camera.has_pose = pose.has_value();
    if (pose) camera.world_from_camera = read_pose(*pose);
    return camera;
}

}  // namespace uw
