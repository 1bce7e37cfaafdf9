#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/image/image_file.h"
#include "dataset/formats.h"
#include "dataset/frame_stamps.h"
#include "dataset/set_files.h"

namespace uw {

namespace {

// The cameras of a rig whose numbers were typed with six digits are parallel to within this.
constexpr double k_parallel = 1e-6;

bool is_pinhole(const CameraDesc& camera) {
    const DistortionDesc none;
    return !camera.port && camera.distortion == none;
}

/// Whether the rig's first two cameras are a rectified pair, the first on the left: they are equal
/// and have neither distortion nor port, and their axes are parallel and across the line between
/// them.
bool is_rectified(const SceneDesc& scene) {
    if (scene.cameras.size() < 2) return false;
    const CameraDesc& left = scene.cameras[0].camera;
    const CameraDesc& right = scene.cameras[1].camera;
    if (!is_pinhole(left) || !is_pinhole(right) || left.width != right.width ||
        left.height != right.height || left.intrinsics.fx != right.intrinsics.fx ||
        left.intrinsics.fy != right.intrinsics.fy || left.intrinsics.cy != right.intrinsics.cy)
        return false;
    const Affine left_from_right = left.world_from_camera.inverse() * right.world_from_camera;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (std::abs(left_from_right.linear()[i][j] - (i == j ? 1 : 0)) > k_parallel)
                return false;
    const Vector3 t = left_from_right.offset();
    return t.x > 0 && std::abs(t.y) <= k_parallel * t.x && std::abs(t.z) <= k_parallel * t.x;
}

/// Throws UsageError of one line for a scene whose disparity is not one number per pixel.
void check_rectified(const DatasetDefinition& definition, const SceneDesc& scene) {
    if (definition.cameras.size() < 2)
        throw UsageError(
            "--format: disparity and kitti are of a pair; give a scene with a rig of two cameras");
    if (!is_rectified(scene))
        throw UsageError(
            "--format: the rig's first two cameras are no rectified pair (equal, without port or "
            "distortion, side by side with parallel axes, the left one first), so that disparity "
            "is not one number per pixel; use --format npy --layers disparity");
}

/// Throws InputError if the disparity of an image is not along its rows.
void check_disparity(const ViewImages& images) {
    // Disparity is accurate to 1e-3 px.
    constexpr double k_along_rows = 1e-3;
    images.for_each_pixel([&](int x, int y) {
        const float across = images.at(Layer::disparity, x, y)[1];
        if (std::isfinite(across) && std::abs(across) > k_along_rows)
            throw InputError(fmt::format(
                "--format disparity: it is {:.3g} px across the rows at pixel {}, {}: the "
                "cameras are not rectified in this frame; use --format npy --layers disparity",
                across, x, y));
    });
}

/// The value of unknown flow: readers take values above 1e9 for that.
constexpr float k_unknown_flow = 1e10F;

/// The .flo of Middlebury's flow benchmark (Baker et al. 2011): 202021.25, width, height, then u
/// and v of each pixel, rows from the top.
std::string flo_text(const ViewImages& images, Layer layer) {
    std::string text;
    append_bytes(text, 202021.25F);
    append_bytes(text, static_cast<std::int32_t>(images.width()));
    append_bytes(text, static_cast<std::int32_t>(images.height()));
    std::vector<float> row(2 * static_cast<std::size_t>(images.width()));
    text.reserve(text.size() +
                 std::span(row).size_bytes() * static_cast<std::size_t>(images.height()));
    for (int y = 0; y < images.height(); ++y) {
        throw_if_stopped();
        auto out = row.begin();
        for (int x = 0; x < images.width(); ++x)
            for (const float value : images.at(layer, x, y).first(2))
                *out++ = std::isfinite(value) ? value : k_unknown_flow;
        append_floats(text, row);
    }
    return text;
}

/// The .pfm of Middlebury's stereo benchmarks: one channel, a negative scale for little-endian,
/// rows from the bottom, infinite where nothing is known.
std::string pfm_text(const ViewImages& images, Layer layer) {
    std::string text = fmt::format("Pf\n{} {}\n-1.0\n", images.width(), images.height());
    images.for_each_pixel([&](int x, int y) {
        const float value = images.at(layer, x, images.height() - 1 - y).front();
        append_bytes(text, std::isfinite(value) ? value : std::numeric_limits<float>::infinity());
    });
    return text;
}

/// Writes an image that is 255 where the other image does not see the point, or there is none.
void write_occluded(const ViewImages& images, SetFiles& files, Layer layer,
                    const std::string& role) {
    DigitalImage image{images.width(), images.height(), 1, 8, false, {}};
    images.for_each_pixel([&](int x, int y) {
        image.values.push_back(images.at(layer, x, y).front() == 0 ? 0 : 255);
    });
    files.add(role, images.definition.file(images.view, role, ".png"),
              [&](const auto& file) { write_png(file, image, {}); });
}

void write_flow(const ViewImages& images, SetFiles& files) {
    if (!images.has_values(Layer::flow)) return;  // the last frame
    files.add_bytes("flow", images.definition.file(images.view, "flow", ".flo"),
                    flo_text(images, Layer::flow));
    write_occluded(images, files, Layer::flow_occluded, "flow_occluded");
}

void write_disparity(const ViewImages& images, SetFiles& files) {
    check_disparity(images);
    files.add_bytes("disparity", images.definition.file(images.view, "disparity", ".pfm"),
                    pfm_text(images, Layer::disparity));
    write_occluded(images, files, Layer::disparity_occluded, "disparity_occluded");
}

}  // namespace

DatasetFormat flow_format() {
    return {.name = "flow",
            .summary = "flow/: optical flow to the next frame, .flo, and where it is occluded",
            .card =
                "`flow/`: where the surface point of a pixel's centre is in the frame with the "
                "next number, in pixels to the right and down, as Middlebury's `.flo`; above 1e9 "
                "where nothing is seen. `flow_occluded/`: PNG, 255 where that frame does not see "
                "the point. The last frame of a sequence has neither.",
            .layers = "flow,flow_occluded",
            .check =
                [](const DatasetDefinition& definition, const SceneDesc&) {
                    if (!definition.frames.front())
                        throw UsageError(
                            "--format flow: the set has no frames; give --frames, of a scene in "
                            "which something moves");
                },
            .write_view = write_flow};
}

DatasetFormat disparity_format() {
    return {.name = "disparity",
            .summary = "disparity/: of a rectified pair, .pfm, and where it is occluded",
            .card =
                "`disparity/`: x of the point in the left image less x in the right one, in "
                "pixels, for both images, as Middlebury's `.pfm`; infinite where nothing is seen. "
                "`disparity_occluded/`: PNG, 255 where the other camera does not see the point.",
            .layers = "disparity,disparity_occluded",
            .check = check_rectified,
            .write_view = write_disparity};
}

namespace {

constexpr std::string_view k_kitti = "kitti/training/";
constexpr std::string_view k_kitti_sequence = "kitti/sequences/00/";  // of the odometry benchmark

/// The file of a pair of frames whose first has this number.
std::string kitti_file(const DatasetDefinition& definition, const View& view,
                       std::string_view folder, int number, std::string_view ending) {
    return fmt::format("{}{}{}/{:06}{}", definition.folder(view.draw), k_kitti, folder, number,
                       ending);
}

/// The disparity as KITTI encodes it: times 256 in 16 bits, 0 where there is none.
DigitalImage encoded_disparity(const ViewImages& images, bool only_visible) {
    DigitalImage image{images.width(), images.height(), 1, 16, false, {}};
    images.for_each_pixel([&](int x, int y) {
        const double value = std::round(256.0 * images.at(Layer::disparity, x, y).front());
        const bool is_known = value >= 1 && value <= 65535;
        const bool is_hidden =
            only_visible && images.at(Layer::disparity_occluded, x, y).front() != 0;
        image.values.push_back(is_known && !is_hidden ? static_cast<std::uint16_t>(value)
                                                      : std::uint16_t{0});
    });
    return image;
}

/// The flow as KITTI encodes it: 64 steps per pixel around 2^15 in the first two channels of 16
/// bits, 1 in the third where it is known.
DigitalImage encoded_flow(const ViewImages& images, bool only_visible) {
    DigitalImage image{images.width(), images.height(), 3, 16, false, {}};
    images.for_each_pixel([&](int x, int y) {
        const std::span<const float> flow = images.at(Layer::flow, x, y);
        const double u = std::round(64.0 * flow[0]) + 32768;
        const double v = std::round(64.0 * flow[1]) + 32768;
        const bool is_hidden = only_visible && images.at(Layer::flow_occluded, x, y).front() != 0;
        const bool is_known =
            u >= 0 && u <= 65535 && v >= 0 && v <= 65535 && !is_hidden;  // false for NaN
        image.values.push_back(is_known ? static_cast<std::uint16_t>(u) : std::uint16_t{0});
        image.values.push_back(is_known ? static_cast<std::uint16_t>(v) : std::uint16_t{0});
        image.values.push_back(is_known ? 1 : 0);
    });
    return image;
}

/// The number of a frame in KITTI's files; none for frames that are the second of a pair only.
std::optional<int> pair_of(const DatasetDefinition& definition, std::size_t frame) {
    const std::optional<int> number = definition.frames[frame];
    if (!number) return 0;
    if (!definition.place_of_frame(*number + 1)) return std::nullopt;
    return number;
}

void write_kitti_images(const ViewImages& images, SetFiles& files) {
    const DatasetDefinition& definition = images.definition;
    const View& view = images.view;
    if (view.camera > 1) return;  // of larger rigs
    const char* const folder = view.camera == 0 ? "image_2" : "image_3";
    // Numbered from 0 without gaps, as the lines of times and poses are.
    write_image(images, files, "image.kitti_sequence",
                fmt::format("{}{}{}/{:06}.png", definition.folder(view.draw), k_kitti_sequence,
                            folder, view.frame));
    const std::optional<int> number = definition.frames[view.frame];
    if (number && *number > 0 && definition.place_of_frame(*number - 1))
        write_image(images, files, "image.kitti_next",
                    kitti_file(definition, view, folder, *number - 1, "_11.png"));
    const std::optional<int> pair = pair_of(definition, view.frame);
    if (!pair) return;
    write_image(images, files, "image.kitti",
                kitti_file(definition, view, folder, *pair, "_10.png"));
    if (view.camera > 0) return;  // ground truth is the left camera's
    const auto add = [&](const std::string& kind, const DigitalImage& image) {
        files.add("kitti." + kind, kitti_file(definition, view, kind, *pair, "_10.png"),
                  [&](const auto& file) { write_png(file, image, {}); });
    };
    if (images.has(Layer::flow)) {
        add("flow_occ", encoded_flow(images, false));
        add("flow_noc", encoded_flow(images, true));
    }
    if (!images.has(Layer::disparity)) return;
    check_disparity(images);
    add("disp_occ_0", encoded_disparity(images, false));
    add("disp_noc_0", encoded_disparity(images, true));
}

/// A projection of points in the axes of the left camera, row by row.
std::array<double, 12> kitti_projection(const CameraDesc& camera, double left_of_it) {
    const IntrinsicsDesc& k = camera.intrinsics;
    return {k.fx, 0.0, k.cx - 0.5, 0 - k.fx * left_of_it, 0.0, k.fy, k.cy - 0.5, 0.0, 0.0,
            0.0,  1.0, 0.0};
}

/// The lines of one camera in calib_cam_to_cam, whose world is the first camera; the first pixel's
/// centre is (0, 0).
std::string calibration_lines(int number, const CameraDesc& camera, double left_of_it) {
    const IntrinsicsDesc& k = camera.intrinsics;
    const DistortionDesc& d = camera.distortion;
    const double cx = k.cx - 0.5, cy = k.cy - 0.5;
    const auto line = [&](const char* name, const auto& values) {
        return fmt::format("{}_{:02}: {:.12e}\n", name, number, fmt::join(values, " "));
    };
    const std::array size{static_cast<double>(camera.width), static_cast<double>(camera.height)};
    const std::array matrix{k.fx, 0.0, cx, 0.0, k.fy, cy, 0.0, 0.0, 1.0};
    const std::array distortion{d.k[0], d.k[1], d.p[0], d.p[1], d.k[2]};
    const std::array identity{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    const std::array translation{0 - left_of_it, 0.0, 0.0};
    return line("S", size) + line("K", matrix) + line("D", distortion) + line("R", identity) +
           line("T", translation) + line("S_rect", size) + line("R_rect", identity) +
           line("P_rect", kitti_projection(camera, left_of_it));
}

double baseline_of(const CameraDesc& left, const CameraDesc& right) {
    return (left.world_from_camera.inverse() * right.world_from_camera).offset().x;
}

void write_calibrations(const CompleteSequence& sequence, SetFiles& files) {
    const DatasetDefinition& definition = sequence.definition;
    for (std::size_t frame = 0; frame < definition.frames.size(); ++frame) {
        const std::optional<int> pair = pair_of(definition, frame);
        if (!pair) continue;
        const CameraDesc& left = sequence.at(frame, 0).camera;
        std::string text = calibration_lines(2, left, 0);
        if (definition.cameras.size() > 1) {
            const CameraDesc& right = sequence.at(frame, 1).camera;
            text += calibration_lines(3, right, baseline_of(left, right));
        }
        files.add_bytes(
            "kitti.calibration",
            kitti_file(definition, {sequence.draw, frame, 0}, "calib_cam_to_cam", *pair, ".txt"),
            text);
    }
}

/// The benchmark's cameras 0 and 2 are on the left, 1 and 3 on the right; Tr is from a laser
/// scanner, for which the left camera is used.
std::string sequence_calibration(const CameraDesc& left, const CameraDesc& right, double baseline) {
    std::string text;
    for (const int number : {0, 1, 2, 3}) {
        const bool is_left = number % 2 == 0;
        const auto projection = kitti_projection(is_left ? left : right, is_left ? 0 : baseline);
        text += fmt::format("P{}: {:.12e}\n", number, fmt::join(projection, " "));
    }
    constexpr std::array k_identity{1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0};
    return text + fmt::format("Tr: {:.12e}\n", fmt::join(k_identity, " "));
}

/// The tables of the odometry benchmark: times since the first frame, and poses of the left camera
/// in the axes that it has there.
void write_kitti_sequence(const CompleteSequence& sequence, SetFiles& files) {
    const DatasetDefinition& definition = sequence.definition;
    const ViewRecord& first = sequence.at(0, 0);
    const Affine first_from_world = first.camera.world_from_camera.inverse();
    std::string times, poses;
    for (std::size_t frame = 0; frame < definition.frames.size(); ++frame) {
        const ViewRecord& record = sequence.at(frame, 0);
        times += seconds_text(record.stamp - first.stamp) + "\n";
        const Affine pose =
            frame == 0 ? Affine() : first_from_world * record.camera.world_from_camera;
        for (int row = 0; row < 3; ++row)
            poses += fmt::format("{:.12e} {:.12e} {:.12e} {:.12e}{}", pose.linear()[0][row],
                                 pose.linear()[1][row], pose.linear()[2][row], pose.offset()[row],
                                 row < 2 ? " " : "\n");
    }
    const std::string folder = fmt::format("{}{}", sequence.folder, k_kitti_sequence);
    const bool is_pair = definition.cameras.size() > 1;
    const CameraDesc& left = first.camera;
    const CameraDesc& right = sequence.at(0, is_pair ? 1 : 0).camera;
    files.add_bytes("kitti.sequence", folder + "calib.txt",
                    sequence_calibration(left, right, is_pair ? baseline_of(left, right) : 0));
    files.add_bytes("kitti.sequence", folder + "times.txt", times);
    files.add_bytes("kitti.sequence", sequence.folder + "kitti/poses/00.txt", poses);
}

void check_kitti(const DatasetDefinition& definition, const SceneDesc& scene) {
    if (definition.cameras.size() > 1) check_rectified(definition, scene);
    const bool has_pairs = std::ranges::any_of(definition.frames, [&](std::optional<int> frame) {
        return frame && definition.place_of_frame(*frame + 1);
    });
    if (definition.frames.front() && !has_pairs)
        throw UsageError(
            "--format kitti: the set has no two consecutive frames; give --frames without steps");
    if (!has_pairs && definition.cameras.size() < 2)
        throw UsageError(
            "--format kitti: the set has neither pairs of frames nor a pair of cameras; give "
            "--frames, or a scene with a rig");
}

}  // namespace

DatasetFormat kitti_format() {
    return {
        .name = "kitti",
        .summary = "kitti/: flow and stereo as in KITTI 2015, and a sequence of its odometry",
        .card =
            "`kitti/training/`: as in KITTI's benchmarks of 2015, a pair of files per frame that "
            "has a next one: `image_2` (left or only camera), `image_3` (right), `_10` this "
            "frame, `_11` the next; `flow_occ` and `flow_noc` (PNG of 16 bits, flow = (value − "
            "2¹⁵)/64, third channel 1 where known), `disp_occ_0`, `disp_noc_0` (disparity = "
            "value/256, 0 where unknown), `noc` without what the other image does not see. Flow "
            "of 512 px and more and disparities of 256 px and more have no code and are left "
            "unknown. `calib_cam_to_cam`: the cameras, of one behind a port as it is in air "
            "(above). "
            "`kitti/sequences/00/` and `kitti/poses/00.txt`: all frames as sequence 00 of the "
            "odometry benchmark, numbered from 0: `image_2`, `image_3`, `times.txt` since the "
            "first frame, poses in the axes of its left camera, and `calib.txt`, in which "
            "cameras 0 and 1 are where 2 and 3 are (where there is one camera, all four), as "
            "pinholes without distortion and port.",
        .layers = "flow,flow_occluded,disparity,disparity_occluded",
        .ports = DatasetFormat::Ports::in_air,  // the odometry's calib.txt has no distortion
        .check = check_kitti,
        .write_view = write_kitti_images,
        .complete = [](const CompleteSequence& sequence, SetFiles& files) {
            write_calibrations(sequence, files);
            write_kitti_sequence(sequence, files);
        }};
}

}  // namespace uw
