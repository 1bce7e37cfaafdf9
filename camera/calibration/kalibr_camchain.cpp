#include <fmt/format.h>

#include <array>

#include "camera/calibration/formats.h"
#include "core/base/text.h"
#include "core/scene/yaml/camera_values.h"

// Kalibr's camchain.yaml: a map cam0, cam1, ... First pixel's centre at (0, 0).

namespace uw {
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
    enum class Model : std::uint8_t { radtan, equidistant, none, fov };
    constexpr std::array<std::pair<std::string_view, Model>, 4> k_models{
        {{"radtan", Model::radtan},
         {"equidistant", Model::equidistant},
         {"none", Model::none},
         {"fov", Model::fov}}};
    const Model which = model.choice(k_models);
    if (which == Model::fov)
        model.fail(
            "the distortion model fov is not supported; calibrate with radtan or equi instead");
    result.model = "pinhole, " + model.node().scalar;
    DistortionDesc& distortion = result.desc.distortion;
    if (which == Model::none) return;
    constexpr auto k_mend = "give the four numbers that go with the distortion model";
    const auto numbers = require_value(camera, "distortion_coeffs", k_mend).list_of(4, k_mend);
    std::array<double, 4> d{};
    for (std::size_t i = 0; i < 4; ++i) d[i] = numbers[i].number(k_mend);
    if (which == Model::equidistant) {
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

}  // namespace uw
