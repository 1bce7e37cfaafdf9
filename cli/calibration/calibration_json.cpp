#include "cli/calibration/calibration_json.h"

#include <numbers>

#include "core/base/version.h"
#include "core/json/json.h"
#include "dataset/camera_json.h"

namespace uw {
namespace {

constexpr double k_degrees = 180 / std::numbers::pi;

Json field(const FieldOfView& field) {
    return {{"horizontal", field.horizontal * k_degrees},
            {"vertical", field.vertical * k_degrees},
            {"diagonal", field.diagonal * k_degrees}};
}

}  // namespace

std::string calibration_json(const CalibrationReport& report) {
    const Calibration& calibration = report.calibration;
    const CameraDesc& camera = calibration.desc;
    const IntrinsicsDesc& i = camera.intrinsics;
    const bool fisheye = camera.distortion.model == DistortionDesc::Model::fisheye;
    Json json;
    json["uwvdb"] = program_version();
    json["file"] = report.file.string();
    json["format"] = word_of(calibration.format);
    json["model"] = calibration.model;
    json["camera"] = calibration.camera;
    json["cameras"] = calibration.cameras;
    json["warnings"] = calibration.warnings;
    json["units"] = "pixels from the image's corner, metres, degrees";
    json["resolution"] = {camera.width, camera.height};
    json["intrinsics"] = {{"fx", i.fx}, {"fy", i.fy}, {"cx", i.cx}, {"cy", i.cy}};
    json["distortion"] = {{"model", fisheye ? "fisheye" : "brown-conrady"},
                          {"k", camera.distortion.k},
                          {"p", camera.distortion.p}};
    json["port"] = camera.port ? port_json(*camera.port) : Json(nullptr);
    json["field_of_view_in_housing"] = field(report.in_lens);
    json["field_of_view_in_water"] = field(report.in_water.value_or(report.in_lens));
    json["fold_angle"] = report.fold_angle ? Json(*report.fold_angle * k_degrees) : Json(nullptr);
    json["fold_radius"] = report.fold_radius ? Json(*report.fold_radius) : Json(nullptr);
    json["pixels_with_a_ray"] = report.covered;
    json["to"] = Json::array();
    for (const auto& target : report.targets)
        if (target.obstacle.empty()) json["to"].push_back(word_of(target.format));
    // Names come from users' files and need not be UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace uw
