// ctest labels: unit metamorphic slow
// Sequences of scenes in which something moves.
#include <gtest/gtest.h>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

using test::ImageFile;

/// The small scene but for its camera, whose pose or trajectory is `camera`, and its box, which has
/// `box` besides.
std::string scene_with(const std::string& camera, const std::string& box,
                       const std::string& render) {
    return R"(uwvdb: 1
camera: {resolution: [33, 19], intrinsics: {fov_x: 60}, port: {distance: 0.02, thickness: 0.01}, )" +
           camera + R"(}
water:
  bands: [620, 540, 450]
  absorption: [0.35, 0.08, 0.05]
  scattering: {b: [0.20, 0.22, 0.25], phase: {type: hg, g: 0.8}}
geometry:
  - {type: plane, point: [0, 0, 4], normal: [0, 0, -1]}
  - {type: box, min: [0.25, -0.25, 1.5], max: [0.5, 0.25, 2], )" +
           box + R"(}
lamps:
  - {name: own, position: [-0.5, -0.2, 0], profile: {type: spot, beam: 80, edge: 20}, intensity: 40}
  - {name: far, position: [1, -1, 0], intensity: 30, frame: world}
render: {samples: 2, )" +
           render + "}\n";
}

constexpr const char* k_camera_path =
    "trajectory: {interpolation: linear, keyframes: [{time: 0, rotate: [0, 0, 0]}, {time: 2, "
    "position: [1, 0, 0.5], rotate: [0, 0, 0]}]}";
constexpr const char* k_box_path =
    "trajectory: {interpolation: linear, keyframes: [{time: 0}, {time: 2, position: [-1, 0.5, "
    "0]}]}";

class MovingScenes : public test::CliTest {
  protected:
    MovingScenes() { write("dive.yaml", scene_with(k_camera_path, k_box_path, "fps: 2")); }
    test::ProgramResult expect_runs(const std::vector<std::string>& arguments) const {
        test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result;
    }
    ImageFile image(const std::string& name) const { return test::read_exr(folder_ / name); }
};

// Frame n at 2 frames per second is n/4 of the way; all places are binary fractions.
TEST_F(MovingScenes, FramesAreTheScenesThatStandStillThere) {
    const test::ProgramResult result = expect_runs(
        {"render", "dive.yaml", "--frames", "0-3", "-o", "all_#.exr", "--layers", "all"});
    EXPECT_EQ(result.err.find("alike"), std::string::npos) << result.err;
    for (int frame = 0; frame < 4; ++frame) {
        const double t = frame / 4.0;
        const auto text = [](double x) { return std::to_string(x); };
        write("still.yaml", scene_with("pose: {rotate: [0, 0, 0], position: [" + text(t) + ", 0, " +
                                           text(t / 2) + "]}",
                                       "reflectance: 0.5", "fps: 2"));
        std::string moved = read("still.yaml");
        const std::string box = "min: [0.25, -0.25, 1.5], max: [0.5, 0.25, 2]";
        moved.replace(moved.find(box), box.size(),
                      "min: [" + text(0.25 - t) + ", " + text(-0.25 + t / 2) + ", 1.5], max: [" +
                          text(0.5 - t) + ", " + text(0.25 + t / 2) + ", 2]");
        write("still.yaml", moved);
        expect_runs({"render", "still.yaml", "-o", "still.exr", "--layers", "all"});
        const ImageFile in_sequence = image("all_" + std::to_string(frame) + ".exr");
        EXPECT_EQ(in_sequence.channels, image("still.exr").channels) << frame;
        EXPECT_EQ(in_sequence.metadata.at("uwvdb/world_from_camera"),
                  image("still.exr").metadata.at("uwvdb/world_from_camera"));
    }
    // Without frames it is the first.
    expect_runs({"render", "dive.yaml", "-o", "first.exr", "--layers", "all"});
    EXPECT_EQ(image("first.exr").channels, image("all_0.exr").channels);
    // A crop is part of the frame.
    expect_runs({"render", "dive.yaml", "--frames", "2", "-o", "crop.exr", "--crop", "4,3,20,15",
                 "--layers", "all"});
    const ImageFile whole = image("all_2.exr"), crop = image("crop.exr");
    for (std::size_t y = 3; y < 15; ++y)
        for (std::size_t x = 4; x < 20; ++x)
            ASSERT_EQ(crop.channels.at("G")[(y - 3) * 16 + x - 4],
                      whole.channels.at("G")[y * 33 + x]);
}

// What a run keeps from the parts of one frame's exposure changes nothing of the next.
TEST_F(MovingScenes, BlurredFramesAreTheSameAlone) {
    write("dive.yaml", scene_with("line_time: 0.001, " + std::string(k_camera_path), k_box_path,
                                  "fps: 2, shutter: 0.2, samples: 8"));
    std::string scene = read("dive.yaml");
    const std::string few = "samples: 2, ";
    write("dive.yaml", scene.erase(scene.find(few), few.size()));
    expect_runs({"render", "dive.yaml", "--frames", "0-2", "-o", "blur_#.exr", "--layers", "all",
                 "--stats", "stats.json"});
    EXPECT_NE(read("stats.json").find("\"exposure_parts\""), std::string::npos);
    EXPECT_NE(read("stats.json").find("\"motion_pixels\""), std::string::npos);
    for (int frame = 0; frame < 3; ++frame) {
        const std::string number = std::to_string(frame);
        expect_runs(
            {"render", "dive.yaml", "--frames", number, "-o", "one.exr", "--layers", "all"});
        const ImageFile one = image("one.exr");
        EXPECT_EQ(image("blur_" + number + ".exr").channels, one.channels) << frame;
        EXPECT_EQ(one.metadata.count("uwvdb/shutter_s"), 1U);
        EXPECT_EQ(one.metadata.count("uwvdb/line_time_s"), 1U);
    }
    const test::ProgramResult again = expect_runs({"render", "dive.yaml", "--frames", "0-2", "-o",
                                                   "blur_#.exr", "--layers", "all", "--resume"});
    EXPECT_NE(again.err.find("resume: frames 0-2 are there already"), std::string::npos)
        << again.err;
}

TEST_F(MovingScenes, AllFramesAreThoseWithAPose) {
    expect_runs({"render", "dive.yaml", "--frames", "all", "-o", "out_#.exr", "--size", "8x5"});
    for (int frame = 0; frame <= 4; ++frame)  // 0 to 2 s at 2 frames per second
        EXPECT_TRUE(exists("out_" + std::to_string(frame) + ".exr")) << frame;
    EXPECT_FALSE(exists("out_5.exr"));
    expect_failure({"render", "scene.yaml", "--frames", "all", "-o", "still_#.exr"}, 2,
                   "--frames all: nothing in the scene has a trajectory");
}

TEST_F(MovingScenes, FramesWithoutAPoseEndTheRunBeforeItBegins) {
    expect_failure({"render", "dive.yaml", "--frames", "3-5", "-o", "out_#.exr"}, 3,
                   "camera.trajectory: has no pose for frame 5, at 2.5 s; its poses are from 0 to "
                   "2 s, which is frames 0-4");
    EXPECT_FALSE(exists("out_3.exr"));
}

TEST_F(MovingScenes, AreContinuedUnlessTheirTrajectoryChanged) {
    write("path.tum", "10 0 0 0 0 0 0 1\n11 0.5 0 0 0 0 0 1\n12 1 0 0.5 0 0 0 1\n");
    write("dive.yaml",
          scene_with("trajectory: {file: path.tum}", "reflectance: 0.5", "times: trajectory"));
    const std::vector<std::string> again{"render", "dive.yaml", "--frames", "0-2",
                                         "-o",     "d_#.exr",   "--resume"};
    expect_runs(again);
    EXPECT_NE(expect_runs(again).err.find("resume: frames 0-2 are there already"),
              std::string::npos);
    const ImageFile before = image("d_2.exr");
    EXPECT_EQ(std::stod(before.metadata.at("uwvdb/time_s")), 2);
    write("path.tum", "10 0 0 0 0 0 0 1\n11 0.5 0 0 0 0 0 1\n12 1 0.5 0.5 0 0 0 1\n");
    EXPECT_EQ(expect_runs(again).err.find("there already"), std::string::npos);
    EXPECT_NE(image("d_2.exr").channels, before.channels);
    // A file that poses are read from is never replaced.
    expect_failure(
        {"render", "dive.yaml", "--frames", "0-1", "-o", "e_#.exr", "--stats", "path.tum"}, 2,
        "would replace a trajectory of the scene");
}

TEST_F(MovingScenes, OtherCommandsShowAFrame) {
    write("points.csv", "x,y,z\n0,0,4\n");
    const std::string first = expect_runs({"project", "dive.yaml", "points.csv"}).out;
    const std::string third =
        expect_runs({"project", "dive.yaml", "points.csv", "--frame", "2"}).out;
    EXPECT_NE(first, third);
    EXPECT_NE(expect_runs({"info", "dive.yaml", "--frame", "2"}).out.find("at (0.5, 0, 0.25)"),
              std::string::npos);
    expect_failure({"info", "scene.yaml", "--frame", "2"}, 2, "nothing moves");
}

}  // namespace
}  // namespace uw
