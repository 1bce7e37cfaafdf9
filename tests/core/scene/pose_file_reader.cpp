// ctest labels: unit
#include "core/scene/pose_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/scene_folder.h"

namespace uw::test {
namespace {

// Half of a right angle's sine and cosine.
constexpr const char* k_r = "0.70710678";

class PoseFiles : public testing::Test {
  protected:
    PoseFile read(PoseFormat format, const std::string& text) const {
        return read_pose_file(folder_.write("poses", text), format, "scene.yaml:3:5: trajectory");
    }
    void expect_refused(PoseFormat format, const std::string& text, const std::string& what) const {
        const std::string message = message_of<InputError>([&] { read(format, text); });
        EXPECT_NE(message.find(what), std::string::npos) << message << "\n  expected: " << what;
        EXPECT_TRUE(message.starts_with("scene.yaml:3:5: trajectory: ")) << message;
    }
    SceneFolder folder_;
};

/// Where the pose takes the camera's right, down and forward.
void expect_axes(const Pose& pose, const Vector3& right, const Vector3& down,
                 const Vector3& forward) {
    const Matrix3 axes = pose.rotation.matrix();
    EXPECT_LT(glm::length(axes[0] - right), 1e-7);
    EXPECT_LT(glm::length(axes[1] - down), 1e-7);
    EXPECT_LT(glm::length(axes[2] - forward), 1e-7);
}

// A quarter turn about y takes z, forward, to x and x, right, to -z.
TEST_F(PoseFiles, TumHasTheCameraInTheWorldWithWLast) {
    const std::string r = k_r;
    const PoseFile file = read(PoseFormat::tum,
                               "# timestamp tx ty tz qx qy qz qw\n\n"
                               "1311868164.5 1 2 3 0 " +
                                   r + " 0 " + r +
                                   "\r\n"
                                   "1311868165.25  4 5 6   0 0 0 1");
    ASSERT_EQ(file.poses.size(), 2U);
    EXPECT_FALSE(file.counts_frames);
    EXPECT_EQ(file.stamps[0], 1311868164500000000);
    EXPECT_EQ(file.poses[0].time, 0);
    EXPECT_EQ(file.poses[1].time, 0.75);
    EXPECT_EQ(file.poses[0].pose.position, (Point3{1, 2, 3}));
    expect_axes(file.poses[0].pose, {0, 0, -1}, {0, 1, 0}, {1, 0, 0});
    expect_axes(file.poses[1].pose, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
}

TEST_F(PoseFiles, EurocHasNanosecondsAndWFirst) {
    const std::string r = k_r;
    const PoseFile file = read(PoseFormat::euroc,
                               "#timestamp, p_RS_R_x [m], p_RS_R_y [m]\n"
                               "1403636580838555648,4.5,-1.7,0.8," +
                                   r + ",0," + r +
                                   ",0,0.1,0.2\n"
                                   "1403636580838555649, 4.5, -1.7, 0.8, 1, 0, 0, 0\n");
    ASSERT_EQ(file.poses.size(), 2U);
    EXPECT_EQ(file.poses[1].time, 1e-9);  // which seconds as doubles do not resolve
    EXPECT_EQ(file.stamps, (std::vector<std::int64_t>{1403636580838555648, 1403636580838555649}));
    EXPECT_EQ(file.poses[0].pose.position, (Point3{4.5, -1.7, 0.8}));
    expect_axes(file.poses[0].pose, {0, 0, -1}, {0, 1, 0}, {1, 0, 0});
}

// camera_from_world: a camera at (1, 2, 3) that looks along the world's x has the world's x in its
// z and the world's z in its -x: t = -R C = -(-3, 2, 1).
TEST_F(PoseFiles, ColmapHasTheWorldInTheCamera) {
    const std::string r = k_r;
    const PoseFile file = read(PoseFormat::colmap,
                               "# Image list with two lines of data per image:\n"
                               "7 " +
                                   r + " 0 -" + r +
                                   " 0 3 -2 -1 1 dive/frame_00012.png\n"
                                   "10 20 -1 30.5 40 7\n"
                                   "3 1 0 0 0 0 0 0 1 dive/frame_00008.png\n"
                                   "\n"
                                   "9 1 0 0 0 0 0 -5 1 dive/frame_00100.png");
    ASSERT_EQ(file.poses.size(), 3U);
    EXPECT_TRUE(file.counts_frames);
    EXPECT_EQ(file.poses[0].time, 8);
    EXPECT_EQ(file.poses[1].time, 12);
    EXPECT_EQ(file.poses[2].time, 100);
    expect_axes(file.poses[1].pose, {0, 0, -1}, {0, 1, 0}, {1, 0, 0});
    EXPECT_LT(distance(file.poses[1].pose.position, {1, 2, 3}), 1e-6);
    EXPECT_LT(distance(file.poses[2].pose.position, {0, 0, 5}), 1e-12);
}

// In the camera y is up and -z forward: the identity looks along -z with -y down.
TEST_F(PoseFiles, NerfstudioHasOpenGlsAxes) {
    const PoseFile file = read(PoseFormat::nerfstudio,
                               R"({"fl_x": 500, "frames": [
            {"file_path": "images/b.png", "transform_matrix":
                [[0, 0, -1, 4], [0, 1, 0, 5], [1, 0, 0, 6], [0, 0, 0, 1]]},
            {"file_path": "images/a.png", "transform_matrix":
                [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]}]})");
    ASSERT_EQ(file.poses.size(), 2U);
    EXPECT_TRUE(file.counts_frames);
    EXPECT_EQ(file.poses[0].time, 0);  // a.png
    EXPECT_EQ(file.poses[0].pose.position, (Point3{1, 2, 3}));
    expect_axes(file.poses[0].pose, {1, 0, 0}, {0, -1, 0}, {0, 0, -1});
    EXPECT_EQ(file.poses[1].time, 1);
    // Its -z, forward, is the world's x; its right the world's z.
    expect_axes(file.poses[1].pose, {0, 0, 1}, {0, -1, 0}, {1, 0, 0});
}

/// COLMAP's images.bin, as its src/colmap/scene/reconstruction_io.cc writes it: the number of
/// images, then of each its number, quaternion, translation, camera and name, and its points.
std::string colmap_bytes(const std::vector<std::pair<std::string, std::array<double, 7>>>& images) {
    std::string bytes;
    const auto add = [&](auto value) {
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    add(std::uint64_t{images.size()});
    std::uint32_t number = 7;
    for (const auto& [name, pose] : images) {
        add(number++);
        for (const double value : pose) add(value);
        add(std::uint32_t{1});
        bytes += name + '\0';
        add(std::uint64_t{2});
        for (int point = 0; point < 2; ++point) {
            add(12.5);
            add(-3.0);
            add(std::int64_t{-1});
        }
    }
    return bytes;
}

// The same poses in both of COLMAP's forms.
TEST_F(PoseFiles, ColmapsBinaryFormIsTheSame) {
    const double r = std::sqrt(0.5);
    const auto binary = read_pose_file(
        folder_.write("images.bin", colmap_bytes({{"f_12.png", {r, 0, r, 0, 1, 2, 3}},
                                                  {"f_8.png", {1, 0, 0, 0, 0, 0, -5}}})),
        PoseFormat::colmap, "scene");
    const PoseFile text = read(PoseFormat::colmap,
                               "1 0.70710678118654757 0 0.70710678118654757 0 1 2 3 1 f_12.png\n"
                               "12.5 -3 -1 12.5 -3 -1\n2 1 0 0 0 0 0 -5 1 f_8.png\n\n");
    EXPECT_EQ(binary.poses, text.poses);
    EXPECT_TRUE(binary.counts_frames);
    const auto named = read_named_poses(folder_.path() / "images.bin", PoseFormat::colmap, "scene");
    ASSERT_EQ(named.size(), 2U);
    EXPECT_EQ(named[0].name, "f_12.png");
    EXPECT_EQ(named[1].pose, text.poses[0].pose);
}

TEST_F(PoseFiles, ColmapsBinaryFormIsRefusedInOneLine) {
    const auto message = [&](const std::string& bytes) {
        return message_of<InputError>([&] {
            read_pose_file(folder_.write("images.bin", bytes), PoseFormat::colmap, "scene");
        });
    };
    const auto expect = [&](const std::string& bytes, const std::string& what) {
        EXPECT_NE(message(bytes).find(what), std::string::npos) << message(bytes);
    };
    const std::string whole = colmap_bytes({{"a.png", {1, 0, 0, 0, 0, 0, 0}}});
    expect("", "images.bin: ends before what it announces");
    for (const std::size_t size : {std::size_t{5}, std::size_t{30}, whole.size() - 1})
        expect(whole.substr(0, size), "ends before what it announces");
    expect(std::string(8, '\xff'), "ends before what it announces");
    expect(std::string(8, '\0'), "has no pose");
    expect(colmap_bytes({{"a.png", {2, 0, 0, 0, 0, 0, 0}}}), "images.bin:1: the quaternion has");
    expect(colmap_bytes({{"a.png", {1, 0, 0, 0, std::nan(""), 0, 0}}}), "has a number that is");
    expect(colmap_bytes({{"a.png", {1, 0, 0, 0, 0, 0, 0}}, {"a.png", {1, 0, 0, 0, 0, 0, 0}}}),
           "the image 'a.png' is there twice");
}

// The numbers in names are those of frames only if nothing else differs.
TEST_F(PoseFiles, OtherNamesAreCountedInTheirOrder) {
    const auto times = [&](const char* a, const char* b) {
        const PoseFile file = read(PoseFormat::colmap, std::string("1 1 0 0 0 1 0 0 1 ") + a +
                                                           "\n\n2 1 0 0 0 2 0 0 1 " + b + "\n\n");
        return std::array{file.poses[0].time, file.poses[1].time, -file.poses[0].pose.position.x};
    };
    EXPECT_EQ(times("9.png", "10.png"), (std::array{9.0, 10.0, 1.0}));
    EXPECT_EQ(times("left_9.png", "right_10.png"), (std::array{0.0, 1.0, 1.0}));
    EXPECT_EQ(times("z.png", "a.png"), (std::array{0.0, 1.0, 2.0}));
    EXPECT_EQ(times("1403636580838555648.png", "1403636580888555648.png"),
              (std::array{0.0, 1.0, 1.0}));
    EXPECT_EQ(times("a 7.png", "a 9.png"), (std::array{7.0, 9.0, 1.0}));
    EXPECT_EQ(times("v.2/x7", "v.2/x9"), (std::array{7.0, 9.0, 1.0}));
}

// Decimal numbers are read as they are written, to the nearest nanosecond.
TEST_F(PoseFiles, TimesAreExact) {
    const auto stamp = [&](PoseFormat format, const std::string& time) {
        const bool is_tum = format == PoseFormat::tum;
        return read(format, time + (is_tum ? " 0 0 0 0 0 0 1\n" : ",0,0,0,1,0,0,0\n")).stamps[0];
    };
    for (const auto& [text, ns] : std::vector<std::pair<std::string, std::int64_t>>{
             {"1403636579.763555584", 1403636579763555584},
             {"1.403636579763555584e9", 1403636579763555584},
             {"1403636579763.555584E-3", 1403636579763555584},
             {"0", 0},
             {"-0.0", 0},
             {"0e30", 0},
             {"-1.000000001", -1000000001},
             {"5.", 5000000000},
             {"0.0000000005", 1},
             {"0.00000000049999999999999999", 0},
             {"-0.0000000015", -2},
             {"1e-300", 0},
             {"1.9999999999", 2000000000},
             {"9007199.254740993", 9007199254740993},
             {"4611686018.427387904", 4611686018427387904}}) {
        EXPECT_EQ(stamp(PoseFormat::tum, text), ns) << text;
    }
    for (const auto& [text, ns] : std::vector<std::pair<std::string, std::int64_t>>{
             {"1403636579763555585", 1403636579763555585},
             {"1403636579763555584.0", 1403636579763555584},
             {"1.403636579763555584e+18", 1403636579763555584},
             {"9007199254740993", 9007199254740993},
             {"-9007199254740993", -9007199254740993},
             {"-5", -5}})
        EXPECT_EQ(stamp(PoseFormat::euroc, text), ns) << text;
}

// Times of a unit that is not the format's are refused with what they may be.
TEST_F(PoseFiles, TimesOfAnotherUnitAreTold) {
    for (const char* time : {"1403636579763555584", "1403636579763555", "1403636579763"})
        expect_refused(PoseFormat::tum, std::string(time) + " 0 0 0 0 0 0 1\n",
                       "which is after the year 2116; divide times in nanoseconds by 1e9");
    expect_refused(PoseFormat::euroc, "1403636579.763555584,0,0,0,1,0,0,0\n",
                   "multiply times in seconds by 1e9, or, if qw comes last, write format: tum");
    const auto doubt = [&](PoseFormat format, const std::string& text, double fps) {
        TrajectoryDesc desc;
        desc.file = folder_.write("poses", text);
        desc.format = format;
        std::string found;
        load_trajectory(desc, fps, found);
        return found;
    };
    const auto lines = [](std::int64_t first, std::int64_t step, const std::string& rest) {
        std::string text;
        for (std::int64_t i = 0; i < 12; ++i) text += std::to_string(first + i * step) + rest;
        return text;
    };
    const std::string tum = " 0 0 0 0 0 0 1\n", euroc = ",0,0,0,1,0,0,0\n";
    EXPECT_NE(doubt(PoseFormat::tum, lines(0, 1, tum), 25).find("as the numbers of frames are"),
              std::string::npos);
    EXPECT_NE(doubt(PoseFormat::tum, lines(1, 1, tum), 25).find("11 s, 276 frames"),
              std::string::npos);
    EXPECT_NE(doubt(PoseFormat::tum, lines(0, 40, tum), 25).find("times in milliseconds by 1000"),
              std::string::npos);
    EXPECT_NE(doubt(PoseFormat::euroc, lines(0, 1, euroc), 25).find("less than a frame"),
              std::string::npos);
    // What is plausible: one frame a second, a clock of 1970, steps of 40 ms.
    EXPECT_EQ(doubt(PoseFormat::tum, lines(0, 1, tum), 1), "");
    EXPECT_EQ(doubt(PoseFormat::tum, lines(1311868164, 1, tum), 25), "");
    EXPECT_EQ(doubt(PoseFormat::euroc, lines(0, 40000000, euroc), 25), "");
}

// Seconds as doubles resolve 240 ns of a time since 1970: a start that far from poses closer than
// that is refused, and not called a fault of the speed.
TEST_F(PoseFiles, AStartThatCannotTellPosesApartIsRefused) {
    TrajectoryDesc desc;
    desc.file = folder_.write("poses",
                              "1403636580838555648,0,0,0,1,0,0,0\n"
                              "1403636580838555649,1,0,0,1,0,0,0\n");
    desc.format = PoseFormat::euroc;
    desc.start = 0;
    desc.where = "scene.yaml:3:5: trajectory";
    std::string doubt;
    EXPECT_NE(message_of<InputError>([&] {
                  load_trajectory(desc, 25, doubt);
              }).find("scene.yaml:3:5: trajectory.start: is so far from poses 1 and 2"),
              std::string::npos);
    desc.start = 1e12;
    EXPECT_NE(message_of<InputError>([&] {
                  load_trajectory(desc, 25, doubt);
              }).find("is after the year 2116"),
              std::string::npos);
    desc.start.reset();
    EXPECT_NO_THROW(load_trajectory(desc, 25, doubt));
    const auto clock = read_pose_clock(desc);
    ASSERT_TRUE(clock);
    EXPECT_EQ(clock->zero, 1403636580838555648);
    EXPECT_EQ(clock->stamps.size(), 2U);
    // A file that was changed in between is another trajectory.
    folder_.write("poses", "1403636580838555648,0,0,0,1,0,0,0\n");
    EXPECT_THROW(read_pose_clock(desc), InputError);
}

TEST_F(PoseFiles, QuaternionsAreNormalised) {
    const PoseFile file = read(PoseFormat::tum, "0 0 0 0 0 0 0 1.0009\n");
    EXPECT_EQ(file.poses[0].pose.rotation, Rotation());
}

TEST_F(PoseFiles, AreRefusedInOneLine) {
    constexpr PoseFormat k_tum = PoseFormat::tum;
    expect_refused(k_tum, "", "poses: has no pose");
    expect_refused(k_tum, "# nothing\n", "has no pose");
    expect_refused(k_tum, "0 1 2 3 0 0 0\n", "poses:1: expected the 8 columns");
    expect_refused(k_tum, "\n0 1 2 3 0 0 0 1 9\n", "poses:2: expected the 8 columns");
    expect_refused(k_tum, "0 1 nan 3 0 0 0 1\n", "poses:1: ty: expected a number");
    expect_refused(k_tum, "0 1 1e13 3 0 0 0 1\n", "at most 1e12");
    expect_refused(k_tum, "inf 1 1 3 0 0 0 1\n", "timestamp: expected a number");
    expect_refused(k_tum, "0 1 2 3 0 0 0 0\n", "length 0, not 1");
    expect_refused(k_tum, "0 1 2 3 0 0 0.1 1\n", "length 1.00499, not 1; check the order");
    expect_refused(k_tum, "1 1 2 3 0 0 0 1\n0 1 2 3 0 0 0 1\n", "poses:2: its time is before");
    expect_refused(k_tum, "1 1 2 3 0 0 0 1\n1 1 2 3 0 0 0 1\n", "poses:2: has the time of");
    constexpr PoseFormat k_euroc = PoseFormat::euroc;
    expect_refused(k_euroc, "1.5,1,2,3,1,0,0,0\n", "whole nanoseconds, found '1.5'");
    expect_refused(k_euroc, "99999999999999999999,1,2,3,1,0,0,0\n", "whole nanoseconds");
    expect_refused(k_euroc, "1,1,2,3,1,0,0\n", "expected the 8 columns ns");
    expect_refused(k_euroc, "1,1,2,3,0,0,0,2\n", "length 2, not 1");
    constexpr PoseFormat k_colmap = PoseFormat::colmap;
    expect_refused(k_colmap, "1 1 0 0 0 0 0 0 1\n\n", "found 9 columns");
    expect_refused(k_colmap, "1 1 0 0 0 0 0 0 1 a.png\n2 1 0 0 0 0 0 0 1 b.png\n1 2 3\n",
                   "poses:3: expected IMAGE_ID");
    expect_refused(k_colmap, "1 1 0 0 0 0 0 0 1 a.png\n\n2 1 0 0 0 0 0 0 1 a.png\n\n",
                   "poses:3: the image 'a.png' is there twice");
    constexpr PoseFormat k_nerf = PoseFormat::nerfstudio;
    expect_refused(k_nerf, "{", "is not JSON");
    expect_refused(k_nerf, "[]", "has no list 'frames'");
    expect_refused(k_nerf, R"({"frames": {}})", "has no list 'frames'");
    expect_refused(k_nerf, R"({"frames": []})", "has no pose");
    expect_refused(k_nerf, R"({"frames": [7]})", "frames[0]: has no transform_matrix");
    const auto matrix = [](const std::string& first) {
        return R"({"frames": [{"transform_matrix": [[)" + first +
               "], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}]}";
    };
    expect_refused(k_nerf, matrix("1, 0, 0"), "four rows of four numbers");
    expect_refused(k_nerf, matrix("1, 0, 0, \"x\""), "four rows of four numbers");
    expect_refused(k_nerf, matrix("1, 0, 0, 1e13"), "above 1e12");
    expect_refused(k_nerf, matrix("2, 0, 0, 0"), "not rigid");
    expect_refused(k_nerf, matrix("-1, 0, 0, 0"), "mirrors");
    expect_refused(k_nerf, matrix("1, 0, 0, NaN"), "is not JSON");
    expect_refused(
        k_nerf, R"({"frames": [{"transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[1,0,0,1]]}]})",
        "does not end in 0, 0, 0, 1");
}

TEST_F(PoseFiles, TooManyPosesAreRefusedWithoutReadingThem) {
    std::string text;
    for (std::size_t i = 0; i <= k_max_poses; ++i) text += std::to_string(i) + " 0 0 0 0 0 0 1\n";
    expect_refused(PoseFormat::tum, text, "poses:1000001: the file has more than a million");
}

TEST_F(PoseFiles, MissingFilesAreNamed) {
    EXPECT_THROW(read_pose_file(folder_.path() / "none.tum", PoseFormat::tum, "scene"), IoError);
}

}  // namespace
}  // namespace uw::test
