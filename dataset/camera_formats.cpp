#include <fmt/format.h>

#include <algorithm>
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

void check_nerfstudio(const DatasetDefinition& definition, const SceneDesc& scene) {
    const auto check = [&](const CameraDesc& camera) {
        if (definition.pinhole_fit && camera.port) return;  // what is fitted has none
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

bool is_fisheye_lens(const CameraDesc& camera) {
    return camera.distortion.model == DistortionDesc::Model::fisheye;
}

const char* nerfstudio_model(const CameraDesc& camera) {
    return is_fisheye_lens(camera) ? "OPENCV_FISHEYE" : "OPENCV";
}

/// nerfstudio's names; the centre of the first pixel is (0.5, 0.5) there, too.
Json intrinsics_json(const CameraDesc& camera) {
    const IntrinsicsDesc& i = camera.intrinsics;
    const DistortionDesc& d = camera.distortion;
    const bool is_fisheye = is_fisheye_lens(camera);
    Json json{{"camera_model", nerfstudio_model(camera)},
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
    Json json = has_one_camera ? intrinsics_json(sequence.portless(0)) : Json::object();
    // It is read from here alone, for all frames.
    if (std::ranges::all_of(sequence.records, [&](const ViewRecord& record) {
            return is_fisheye_lens(record.camera) == is_fisheye_lens(first);
        }))
        json["camera_model"] = nerfstudio_model(first);
    if (definition.has_format("depth"))
        json["depth_unit_scale_factor"] = 1 / definition.depth_scale;
    if (first.port) json["uwvdb_port"] = camera_json(first).at("port");
    if (definition.has_format("colmap")) json["ply_file_path"] = k_point_cloud_file;
    Json frames = Json::array();
    for (const ViewRecord& record : sequence.records) {
        Json frame{{"file_path", within(sequence, "", *record.file("image"))}};
        if (!has_one_camera) frame.update(intrinsics_json(sequence.portless(record.view.camera)));
        if (const SetFile* depth = record.file("depth"))
            frame["depth_file_path"] = within(sequence, "", *depth);
        if (const SetFile* mask = record.file("mask"))
            frame["mask_path"] = within(sequence, "", *mask);
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
                "`transforms.json`: nerfstudio's, beside `images/`: world from camera with x "
                "right, y up, z backward, in metres; the first pixel's centre is (0.5, 0.5). It "
                "names `depth/` and `masks/`, by which nerfstudio leaves out what is only water, "
                "if they are in the set, and with `sparse/0` the same points in `sparse_pc.ply`. "
                "nerfstudio takes depths for millimetres: where `depth_unit_scale_factor` is not "
                "0.001, its parser needs that value as `--depth-unit-scale-factor`. It has one "
                "`camera_model` for all images: those of a rig that mixes fisheyes with other "
                "lenses are read as perspective, so that such cameras need sets of their own. "
                "Behind a port intrinsics are those in air, or fitted (above), and `uwvdb_port`, "
                "which nerfstudio does not read, describes the port. Poses are the true camera's.",
            .needs_images = true,
            .ports = DatasetFormat::Ports::fitted,
            .check = check_nerfstudio,
            .complete = write_transforms};
}

}  // namespace uw
