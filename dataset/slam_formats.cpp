#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "camera/calibration.h"
#include "core/base/error.h"
#include "dataset/formats.h"
#include "dataset/frame_stamps.h"
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

// Readers cut the names of images into seconds and nine digits of nanoseconds, and sort them as
// text. So all have 19 digits, as the benchmark's, whose clock began in 1970, have; those of other
// clocks are counted from May 2014 [ns].
constexpr std::int64_t k_min_of_19_digits = 1'000'000'000'000'000'000;
constexpr std::int64_t k_start_of_others = 1'400'000'000'000'000'000;

bool has_19_digits(std::int64_t stamp) {
    return stamp >= k_min_of_19_digits;
}

std::int64_t euroc_stamp(std::int64_t stamp) {
    return has_19_digits(stamp) ? stamp : k_start_of_others + stamp;
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

std::string matrix_yaml(const Affine& map) {
    std::string text = "T_BS:\n  cols: 4\n  rows: 4\n  data: [";
    for (int row = 0; row < 3; ++row)
        text += fmt::format("{}, {}, {}, {},\n         ", map.linear()[0][row],
                            map.linear()[1][row], map.linear()[2][row], map.offset()[row]);
    return text + "0.0, 0.0, 0.0, 1.0]\n";
}

/// `note` is a comment on the intrinsics, or empty.
std::string camera_yaml(const CameraDesc& camera, const char* note, const Affine& body_from_camera,
                        double rate) {
    const IntrinsicsDesc& k = camera.intrinsics;
    const DistortionDesc& d = camera.distortion;
    const bool is_fisheye = d.model == DistortionDesc::Model::fisheye;
    const std::array<double, 4> coefficients = is_fisheye
                                                   ? std::array{d.k[0], d.k[1], d.k[2], d.k[3]}
                                                   : std::array{d.k[0], d.k[1], d.p[0], d.p[1]};
    std::string text = "# The body is the first camera.\n";
    text += note;
    text += "sensor_type: camera\ncomment: rendered\n" + matrix_yaml(body_from_camera);
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
    std::string text =
        "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
        "q_RS_z [], v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1],"
        " b_w_RS_S_y [rad s^-1], b_w_RS_S_z [rad s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], "
        "b_a_RS_S_z [m s^-2]\n";
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
    const Affine body_from_world = sequence.at(0, 0).camera.world_from_camera.inverse();
    for (std::size_t camera = 0; camera < definition.cameras.size(); ++camera) {
        std::string table = "#timestamp [ns],filename\n";
        for (std::size_t frame = 0; frame < frames; ++frame) {
            const std::int64_t stamp = euroc_stamp(sequence.at(frame, camera).stamp);
            table += fmt::format("{0},{0}.png\n", stamp);
        }
        const std::string folder = cam_folder(definition, sequence.draw, camera);
        const CameraDesc& desc = sequence.at(0, camera).camera;
        const Affine body_from_camera =
            camera == 0 ? Affine() : body_from_world * desc.world_from_camera;
        files.add_bytes("euroc", folder + "data.csv", table);
        const char* const note =
            !desc.port ? ""
            : definition.pinhole_fit
                ? "# Behind a port, which this format has no words for: fitted to the rays in "
                  "water.\n"
                : "# Behind a port, which this format has no words for: as it is in air.\n";
        files.add_bytes("euroc", folder + "sensor.yaml",
                        camera_yaml(sequence.portless(camera), note, body_from_camera, rate));
    }
    const std::string folder = sequence.folder + "mav0/state_groundtruth_estimate0/";
    files.add_bytes("euroc", folder + "data.csv", truth_csv(sequence));
    files.add_bytes("euroc", folder + "sensor.yaml",
                    "sensor_type: visual-inertial\ncomment: the poses rendered, without "
                    "error\n" +
                        matrix_yaml(Affine()));
}

}  // namespace

DatasetFormat euroc_format() {
    return {.name = "euroc",
            .summary = "mav0/: EuRoC (ASL): cam0, cam1, ..., state_groundtruth_estimate0",
            .card =
                "`mav0/`: the layout of EuRoC and other ASL data sets: `cam0/data` and so on, "
                "named by time in nanoseconds of 19 digits (clocks of fewer have 1 400 000 000 s "
                "added), "
                "`sensor.yaml` with intrinsics (first pixel's centre at (0, 0)) and `T_BS`, and "
                "`state_groundtruth_estimate0`. The body is the first camera. Velocities are "
                "differences of the positions in the frames around; there is no IMU, and biases "
                "are 0. Behind a port intrinsics are those in air, or fitted (above).",
            .ports = DatasetFormat::Ports::fitted,
            .check = check_euroc,
            .write_view = write_euroc_image,
            .complete = write_euroc_tables};
}

}  // namespace uw
