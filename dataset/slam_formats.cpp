#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "camera/calibration.h"
#include "core/base/error.h"
#include "dataset/formats.h"
#include "dataset/frame_stamps.h"
#include "dataset/sensor_files.h"
#include "render/image_scene.h"

namespace uw {

namespace {

constexpr double k_tum_depth_scale = 5000;  // per metre, the benchmark's

/// "tum/", or "tum/left/" in a rig: the benchmark's sequences have one camera.
std::string tum_folder(const DatasetDefinition& definition, const View& view) {
    const std::string& camera = definition.cameras[view.camera];
    return definition.folder(view.draw) + "tum/" + (camera.empty() ? "" : camera + "/");
}

void write_tum_images(const ViewImages& images, SetFiles& files) {
    const std::string folder = tum_folder(images.definition, images.view);
    const std::string file = seconds_text(images.stamp) + ".png";
    write_image(images, files, "image.tum", folder + "rgb/" + file);
    write_depth(images, files, "depth.tum", folder + "depth/" + file, k_tum_depth_scale);
}

void write_tum_tables(const CompleteSequence& sequence, SetFiles& files) {
    const DatasetDefinition& definition = sequence.definition;
    for (std::size_t camera = 0; camera < definition.cameras.size(); ++camera) {
        std::string rgb = "# color images\n# timestamp filename\n";
        std::string depth = "# depth maps\n# timestamp filename\n";
        std::string truth = "# ground truth trajectory\n# timestamp tx ty tz qx qy qz qw\n";
        std::string associations;
        for (std::size_t frame = 0; frame < definition.frames.size(); ++frame) {
            const ViewRecord& record = sequence.at(frame, camera);
            const std::string time = seconds_text(record.stamp);
            rgb += fmt::format("{0} rgb/{0}.png\n", time);
            depth += fmt::format("{0} depth/{0}.png\n", time);
            associations += fmt::format("{0} rgb/{0}.png {0} depth/{0}.png\n", time);
            const auto [p, q] = camera_pose(record.camera);
            truth +=
                fmt::format("{} {} {} {} {} {} {} {}\n", time, p.x, p.y, p.z, q.x, q.y, q.z, q.w);
        }
        const std::string folder = tum_folder(definition, {sequence.draw, 0, camera});
        files.add_bytes("tum", folder + "rgb.txt", rgb);
        files.add_bytes("tum", folder + "depth.txt", depth);
        files.add_bytes("tum", folder + "groundtruth.txt", truth);
        files.add_bytes("tum", folder + "associations.txt", associations);
    }
}

}  // namespace

DatasetFormat tum_format() {
    return {.name = "tum",
            .summary = "tum/: RGB-D sequence of the TUM benchmark, depth at 5000 per metre",
            .card =
                "`tum/`: as the TUM RGB-D benchmark has it, a folder per camera of a rig: `rgb/` "
                "and `depth/` named by time in seconds, depth as PNG of 16 bits at 5000 per metre "
                "(0: none), `rgb.txt`, `depth.txt`, `associations.txt`, and `groundtruth.txt` "
                "with the camera's pose in the world (x right, y down, z forward).",
            .layers = "depth",
            .write_view = write_tum_images,
            .complete = write_tum_tables};
}

namespace {

/// Whether EuRoC has a stamp as it is.
bool has_19_digits(std::int64_t stamp) {
    return euroc_stamp(stamp) == stamp;
}

std::string cam_folder(const DatasetDefinition& definition, std::size_t draw, std::size_t camera) {
    return fmt::format("{}mav0/cam{}/", definition.folder(draw), camera);
}

/// Throws UsageError if only some frames have stamps of 19 digits.
void check_euroc_stamps(const DatasetDefinition& definition, const SceneDesc& scene) {
    if (!has_motion(scene)) return;
    const FrameStamps stamps(scene);
    std::optional<std::int64_t> least, most;
    for (const std::optional<int>& frame : definition.frames) {
        const double time = frame ? time_of_frame(scene, *frame) : first_time(scene);
        const std::int64_t stamp = stamps.at(frame, time);
        least = std::min(stamp, least.value_or(stamp));
        most = std::max(stamp, most.value_or(stamp));
    }
    if (has_19_digits(*least) != has_19_digits(*most) || !has_19_digits(euroc_stamp(*least)))
        throw UsageError(fmt::format(
            "--format euroc: its stamps have 19 digits, but those of the poses, from {} to {} ns, "
            "are on both sides of 10^18 or below -4 * 10^17; give the trajectory other times",
            *least, *most));
}

void check_euroc(const DatasetDefinition& definition, const SceneDesc& scene) {
    check_euroc_stamps(definition, scene);
    const auto check = [](const CameraDesc& camera) {
        const std::string obstacle = calibration_obstacle(
            CalibrationFormat::kalibr, without_port(camera, std::nullopt, false));
        if (!obstacle.empty())
            throw UsageError(fmt::format("--format euroc: {}; leave the format out", obstacle));
    };
    if (scene.cameras.empty()) check(scene.camera);
    for (const RigCameraDesc& entry : scene.cameras) check(entry.camera);
}

/// `body` and `note` are comments, on what the body is and on the intrinsics; `note` may be empty.
std::string camera_yaml(const CameraDesc& camera, const char* body, const char* note,
                        const Affine& body_from_camera, double rate) {
    const IntrinsicsDesc& k = camera.intrinsics;
    const DistortionDesc& d = camera.distortion;
    const bool is_fisheye = d.model == DistortionDesc::Model::fisheye;
    const std::array<double, 4> coefficients = is_fisheye
                                                   ? std::array{d.k[0], d.k[1], d.k[2], d.k[3]}
                                                   : std::array{d.k[0], d.k[1], d.p[0], d.p[1]};
    std::string text = body;
    text += note;
    text += "sensor_type: camera\ncomment: rendered\n" + euroc_pose_yaml(body_from_camera);
    text += fmt::format(
        "rate_hz: {:.9g}\nresolution: [{}, {}]\ncamera_model: pinhole\n"
        "intrinsics: [{}, {}, {}, {}] #fu, fv, cu, cv\ndistortion_model: {}\n"
        "distortion_coefficients: [{}]\n",
        rate, camera.width, camera.height, k.fx, k.fy, k.cx - 0.5, k.cy - 0.5,
        is_fisheye ? "equidistant" : "radial-tangential", fmt::join(coefficients, ", "));
    return text;
}

/// The velocity of the first camera, from the differences of its positions in the frames around.
Vector3 velocity_at(const CompleteSequence& sequence, std::size_t frame) {
    const std::size_t last = sequence.definition.frames.size() - 1;
    const ViewRecord& a = sequence.at(frame == 0 ? 0 : frame - 1, 0);
    const ViewRecord& b = sequence.at(std::min(frame + 1, last), 0);
    if (!(b.time > a.time)) return Vector3(0.0);
    return (b.camera.world_from_camera.offset() - a.camera.world_from_camera.offset()) /
           (b.time - a.time);
}

std::string truth_csv(const CompleteSequence& sequence) {
    std::string text = k_euroc_truth_header;
    for (std::size_t frame = 0; frame < sequence.definition.frames.size(); ++frame) {
        const ViewRecord& record = sequence.at(frame, 0);
        const auto [p, q] = camera_pose(record.camera);
        const Vector3 v = velocity_at(sequence, frame);
        text +=
            fmt::format("{},{},{},{},{},{},{},{},{},{},{},0,0,0,0,0,0\n", euroc_stamp(record.stamp),
                        p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z);
    }
    return text;
}

void write_euroc_image(const ViewImages& images, SetFiles& files) {
    write_image(images, files, "image.euroc",
                fmt::format("{}data/{}.png",
                            cam_folder(images.definition, images.view.draw, images.view.camera),
                            euroc_stamp(images.stamp)));
}

void write_euroc_tables(const CompleteSequence& sequence, SetFiles& files) {
    const DatasetDefinition& definition = sequence.definition;
    const std::size_t frames = definition.frames.size();
    const double seconds = sequence.at(frames - 1, 0).time - sequence.at(0, 0).time;
    const double rate = seconds > 0 ? static_cast<double>(frames - 1) / seconds : 0;
    const bool has_imu = !sequence.imu_from_cameras.empty();
    const Affine first_from_world = sequence.at(0, 0).camera.world_from_camera.inverse();
    const auto body_from_camera = [&](std::size_t camera) {
        if (has_imu) return sequence.imu_from_cameras[camera];
        const CameraDesc& desc = sequence.at(0, camera).camera;
        return camera == 0 ? Affine() : first_from_world * desc.world_from_camera;
    };
    std::vector<ChainedCamera> chain;
    for (std::size_t camera = 0; camera < definition.cameras.size(); ++camera) {
        std::string table = "#timestamp [ns],filename\n";
        for (std::size_t frame = 0; frame < frames; ++frame) {
            const std::int64_t stamp = euroc_stamp(sequence.at(frame, camera).stamp);
            table += fmt::format("{0},{0}.png\n", stamp);
        }
        const std::string folder = cam_folder(definition, sequence.draw, camera);
        const CameraDesc& desc = sequence.at(0, camera).camera;
        files.add_bytes("euroc", folder + "data.csv", table);
        const char* const note =
            !desc.port ? ""
            : definition.pinhole_fit
                ? "# Behind a port, which this format has no words for: fitted to the rays in "
                  "water.\n"
                : "# Behind a port, which this format has no words for: as it is in air.\n";
        const char* const body =
            has_imu ? "# The body is imu0.\n" : "# The body is the first camera.\n";
        files.add_bytes(
            "euroc", folder + "sensor.yaml",
            camera_yaml(sequence.portless(camera), body, note, body_from_camera(camera), rate));
        chain.push_back({sequence.portless(camera), body_from_camera(camera).inverse()});
    }
    if (has_imu) {
        // The rest of what an IMU needs is there already (share_euroc_imu).
        files.add_bytes("euroc", sequence.folder + "mav0/camchain-imucam.yaml",
                        write_kalibr_chain(chain));
        return;
    }
    const std::string folder = sequence.folder + "mav0/state_groundtruth_estimate0/";
    files.add_bytes("euroc", folder + "data.csv", truth_csv(sequence));
    files.add_bytes("euroc", folder + "sensor.yaml",
                    "sensor_type: visual-inertial\ncomment: the poses rendered, without "
                    "error\n" +
                        euroc_pose_yaml(Affine()));
}

std::vector<NamedText> share_euroc_imu(const DatasetDefinition& definition, std::size_t draw,
                                       const SceneDesc& scene) {
    if (!has_imu(scene)) return {};
    std::vector<NamedText> files;
    for (NamedText& file : euroc_imu_files(scene, span_of_frames(definition, scene)))
        files.push_back({definition.folder(draw) + "mav0/" + file.name, std::move(file.text)});
    files.push_back({imu_mounts_file(definition, draw), imu_mounts_text(definition, scene)});
    return files;
}

}  // namespace

DatasetFormat euroc_format() {
    return {.name = "euroc",
            .summary = "mav0/: EuRoC (ASL): cam0, ..., imu0, state_groundtruth_estimate0",
            .card =
                "`mav0/`: the layout of EuRoC and other ASL data sets: `cam0/data` and so on, "
                "named by time in nanoseconds of 19 digits (clocks of fewer have 1 400 000 000 s "
                "added), "
                "`sensor.yaml` with intrinsics (first pixel's centre at (0, 0)) and `T_BS`, and "
                "`state_groundtruth_estimate0`. With an IMU the body is the first of them: `imu0` "
                "has its readings, the ground truth poses, velocities and biases at their times, "
                "and `camchain-imucam.yaml` the cameras for Kalibr, with `T_cam_imu`; scale, "
                "misalignment and range of an IMU, and other sensors, have no place here. Without "
                "an IMU the body is the first camera, velocities are differences of the positions "
                "in the frames around, and biases are 0. Behind a port intrinsics are those in "
                "air, or fitted (above).",
            .ports = DatasetFormat::Ports::fitted,
            .check = check_euroc,
            .share = share_euroc_imu,
            .write_view = write_euroc_image,
            .complete = write_euroc_tables};
}

namespace {

void check_sensors(const DatasetDefinition& definition, const SceneDesc& scene) {
    if (scene.navigation.empty())
        throw UsageError(
            "--format sensors: the scene has no sensors of a vehicle; add sensors: [{type: imu}] "
            "to it, or leave the format out");
    if (definition.formats.size() == 1)
        throw UsageError(
            "--format sensors: has no images; add png or another format, or use uwvdb record, "
            "which renders nothing");
}

std::vector<NamedText> share_sensors(const DatasetDefinition& definition, std::size_t draw,
                                     const SceneDesc& scene) {
    std::vector<NamedText> files = sensor_files(scene, span_of_frames(definition, scene));
    for (NamedText& file : files) file.name = definition.folder(draw) + "sensors/" + file.name;
    return files;
}

}  // namespace

DatasetFormat sensors_format() {
    return {.name = "sensors",
            .summary = "sensors/: IMU, pressure, DVL, ... as CSV, with the truth",
            .card =
                "`sensors/`: `NAME.csv` of each sensor of the vehicle, its readings and beside "
                "them the truth (`_true`), with `stamp_ns`, the same clock as the images'; empty: "
                "no reading. The first line has the units. `NAME.yaml`: an IMU as Kalibr has it. "
                "`trajectory.tum` and `trajectory.csv`: the body (rig or camera) in the world, "
                "the latter with velocities in EuRoC's columns. `sensors.json`: where sensors and "
                "cameras are in the body's axes.",
            .check = check_sensors,
            .share = share_sensors};
}

}  // namespace uw
