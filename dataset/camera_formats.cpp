#include <fmt/format.h>

#include <array>
#include <string>

#include "camera/calibration.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "dataset/camera_json.h"
#include "dataset/formats.h"

namespace uw {

namespace {

void write_camera_files(const CompleteSequence& sequence, SetFiles& files) {
    const DatasetDefinition& definition = sequence.definition;
    for (std::size_t camera = 0; camera < definition.cameras.size(); ++camera) {
        const CameraDesc& desc = sequence.at(0, camera).camera;
        const std::string& name = definition.cameras[camera];
        for (const CalibrationFormat format : calibration_formats()) {
            if (!calibration_obstacle(format, desc).empty()) continue;
            const char* const ending = format == CalibrationFormat::colmap ? "txt" : "yaml";
            files.add_bytes("calibration",
                            fmt::format("{}calibration/{}{}.{}", sequence.folder,
                                        name.empty() ? "" : name + ".", word_of(format), ending),
                            write_calibration(format, desc));
        }
    }
}

}  // namespace

DatasetFormat calibration_format() {
    return {
        .name = "calibration",
        .summary = "calibration/: the cameras as OpenCV, ROS, Kalibr, COLMAP and others have them",
        .card =
            "`calibration/`: each camera's resolution, intrinsics, distortion and port in the "
            "formats that can express them, as `uwvdb calibration` writes them.",
        .complete = write_camera_files};
}

namespace {

void check_nerfstudio(const DatasetDefinition&, const SceneDesc& scene) {
    const auto check = [](const CameraDesc& camera) {
        const auto& k = camera.distortion.k;
        if (camera.distortion.model == DistortionDesc::Model::brown_conrady &&
            (k[3] != 0 || k[4] != 0 || k[5] != 0))
            throw UsageError(
                "--format nerfstudio: it has no rational distortion (k4 to k6); leave the format "
                "out");
    };
    if (scene.cameras.empty()) check(scene.camera);
    for (const RigCameraDesc& entry : scene.cameras) check(entry.camera);
}

/// nerfstudio's names; the centre of the first pixel is (0.5, 0.5) there, too.
Json intrinsics_json(const CameraDesc& camera) {
    const IntrinsicsDesc& i = camera.intrinsics;
    const DistortionDesc& d = camera.distortion;
    const bool is_fisheye = d.model == DistortionDesc::Model::fisheye;
    Json json{{"camera_model", is_fisheye ? "OPENCV_FISHEYE" : "OPENCV"},
              {"w", camera.width},
              {"h", camera.height},
              {"fl_x", i.fx},
              {"fl_y", i.fy},
              {"cx", i.cx},
              {"cy", i.cy},
              {"k1", d.k[0]},
              {"k2", d.k[1]},
              {"k3", d.k[2]},
              {"k4", is_fisheye ? d.k[3] : 0.0}};
    if (!is_fisheye) {
        json["p1"] = d.p[0];
        json["p2"] = d.p[1];
    }
    return json;
}

/// The camera's pose with x right, y up, z backward, as OpenGL has it.
Json opengl_rows(const Affine& world_from_camera) {
    const Matrix3& m = world_from_camera.linear();
    Json rows = Json::array();
    for (int row = 0; row < 3; ++row)
        rows.push_back({m[0][row], -m[1][row], -m[2][row], world_from_camera.offset()[row]});
    rows.push_back({0.0, 0.0, 0.0, 1.0});
    return rows;
}

void write_transforms(const CompleteSequence& sequence, SetFiles& files) {
    const DatasetDefinition& definition = sequence.definition;
    const bool has_one_camera = definition.cameras.size() == 1;
    const CameraDesc& first = sequence.records.front().camera;
    Json json = has_one_camera ? intrinsics_json(first) : Json::object();
    if (definition.has_format("depth"))
        json["depth_unit_scale_factor"] = 1 / definition.depth_scale;
    if (first.port) json["uwvdb_port"] = camera_json(first).at("port");
    Json frames = Json::array();
    for (const ViewRecord& record : sequence.records) {
        Json frame{{"file_path", within(sequence, "", *record.file("image"))}};
        if (!has_one_camera) frame.update(intrinsics_json(record.camera));
        if (const SetFile* depth = record.file("depth"))
            frame["depth_file_path"] = within(sequence, "", *depth);
        frame["transform_matrix"] = opengl_rows(record.camera.world_from_camera);
        frames.push_back(std::move(frame));
    }
    json["frames"] = std::move(frames);
    files.add_bytes("nerfstudio", sequence.folder + "transforms.json", json_text(json));
}

}  // namespace

DatasetFormat nerfstudio_format() {
    return {.name = "nerfstudio",
            .summary = "transforms.json of nerfstudio, OpenGL axes; brings png along",
            .card =
                "`transforms.json`: nerfstudio's, beside `images/` (and `depth/`, if it is in the "
                "set): world from camera with x right, y up, z backward, in metres; the first "
                "pixel's centre is (0.5, 0.5). Behind a port intrinsics are those in air, and "
                "`uwvdb_port`, which nerfstudio does not read, describes the port.",
            .needs_images = true,
            .check = check_nerfstudio,
            .complete = write_transforms};
}

}  // namespace uw
