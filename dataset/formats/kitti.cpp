#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/image/image_writer.h"
#include "dataset/formats/formats.h"
#include "dataset/formats/stereo_pair.h"

namespace uw {

namespace {

constexpr std::string_view k_kitti = "kitti/training/";

/// A file by its pair of frames, whose first has this number.
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

void write_pair(const ViewImages& images, SetFiles& files) {
    const DatasetDefinition& definition = images.definition;
    const View& view = images.view;
    if (view.camera > 1) return;  // of larger rigs
    const char* const folder = view.camera == 0 ? "image_2" : "image_3";
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
    const std::array projection{k.fx, 0.0, cx, 0 - k.fx * left_of_it, 0.0, k.fy, cy, 0.0, 0.0,
                                0.0,  1.0, 0.0};
    return line("S", size) + line("K", matrix) + line("D", distortion) + line("R", identity) +
           line("T", translation) + line("S_rect", size) + line("R_rect", identity) +
           line("P_rect", projection);
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
            const Affine left_from_right =
                left.world_from_camera.inverse() * right.world_from_camera;
            text += calibration_lines(3, right, left_from_right.offset().x);
        }
        files.add_bytes(
            "kitti.calibration",
            kitti_file(definition, {sequence.draw, frame, 0}, "calib_cam_to_cam", *pair, ".txt"),
            text);
    }
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
        .summary = "kitti/: flow and stereo as in KITTI 2015, 16-bit PNG, with calibrations",
        .card =
            "`kitti/training/`: as in KITTI's benchmarks of 2015, a pair of files per frame that "
            "has a next one: `image_2` (left or only camera), `image_3` (right), `_10` this "
            "frame, `_11` the next; `flow_occ` and `flow_noc` (PNG of 16 bits, flow = (value − "
            "2¹⁵)/64, third channel 1 where known), `disp_occ_0`, `disp_noc_0` (disparity = "
            "value/256, 0 where unknown), `noc` without what the other image does not see. Flow "
            "of 512 px and more and disparities of 256 px and more have no code and are left "
            "unknown. `calib_cam_to_cam`: the cameras, of one behind a port as it is in air.",
        .layers = "flow,flow_occluded,disparity,disparity_occluded",
        .check = check_kitti,
        .write_view = write_pair,
        .complete = write_calibrations};
}

}  // namespace uw
