// ctest labels: unit metamorphic
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

using test::ImageFile;

// A wall at z = 4 with a box before it; f = 40 px and a baseline of 0.4 m: 4 px of disparity.
constexpr const char* k_camera = "resolution: [32, 18], intrinsics: {fx: 40}";
constexpr const char* k_world = R"(
water:
  bands: [620, 540, 450]
  absorption: [0.35, 0.08, 0.05]
  scattering: {b: [0.20, 0.22, 0.25], phase: {type: hg, g: 0.8}}
geometry:
  - {type: plane, point: [0, 0, 4], normal: [0, 0, -1]}
  - {type: box, min: [0.2, -0.3, 1.5], max: [0.6, 0.2, 1.9], reflectance: [0.7, 0.4, 0.2]}
)";

std::string pose(double x) {
    return "pose: {position: [" + std::to_string(x) + ", 0, 0], look_at: [" + std::to_string(x) +
           ", 0, 1], up: [0, -1, 0]}";
}

/// "rig.yaml": a stereo rig; "left.yaml" and "right.yaml": each of its cameras by itself.
class Rigs : public test::CliTest {
  protected:
    Rigs() {
        const std::string camera = k_camera;
        const std::string world =
            std::string(k_world) +
            "lamps:\n  - {name: a, position: [-0.5, -0.2, 0], intensity: 50, frame: world}\n";
        write("rig.yaml", "uwvdb: 1\ncameras:\n  - {name: left, " + camera +
                              "}\n  - {name: right, " + camera + ", " + pose(0.4) + "}" + world);
        write("left.yaml", "uwvdb: 1\ncamera: {" + camera + "}" + world);
        write("right.yaml", "uwvdb: 1\ncamera: {" + camera + ", " + pose(0.4) + "}" + world);
    }

    test::ProgramResult expect_runs(const std::vector<std::string>& arguments) const {
        test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result;
    }
    ImageFile image(const std::string& name) const { return test::read_exr(folder_ / name); }
    void expect_same_pixels(const std::string& a, const std::string& b) const {
        const ImageFile first = image(a), second = image(b);
        ASSERT_EQ(first.names, second.names);
        for (const std::string& name : first.names)
            EXPECT_EQ(first.channels.at(name), second.channels.at(name)) << a << " " << name;
    }
};

TEST_F(Rigs, EachImageIsToTheBitThatOfItsCameraAlone) {
    expect_runs({"render", "rig.yaml", "-o", "out.exr", "--layers", "all"});
    EXPECT_FALSE(exists("out.exr"));
    for (const std::string camera : {"left", "right"}) {
        expect_runs({"render", camera + ".yaml", "-o", "one.exr", "--layers", "all"});
        expect_same_pixels("out." + camera + ".exr", "one.exr");
        EXPECT_TRUE(exists("out." + camera + ".png"));
        EXPECT_EQ(image("out." + camera + ".exr").metadata.at("uwvdb/camera"), camera);
    }
    const auto left = image("out.left.exr").metadata, right = image("out.right.exr").metadata;
    EXPECT_EQ(left.at("uwvdb/world_from_camera"), "1 0 0 0; 0 1 0 0; 0 0 1 0");
    EXPECT_NE(right.at("uwvdb/world_from_camera").find(" 0.4"), std::string::npos);
    EXPECT_EQ(left.at("uwvdb/intrinsics_fx_fy_cx_cy_px"), "40 40 16 9");
}

TEST_F(Rigs, APlanesDisparityIsThatOfPinholes) {
    expect_runs({"render", "rig.yaml", "-o", "{camera}_out.exr", "--layers", "all", "--set",
                 "geometry[1]={type: sphere, center: [0, 0, 9], radius: 1}"});
    const ImageFile left = image("left_out.exr"), right = image("right_out.exr");
    for (int y = 0; y < 18; ++y) {
        for (int x = 4; x < 32; ++x) {  // f B / Z = 40 * 0.4 / 4 = 4 px
            for (const char* const axis : {"position.X", "position.Y", "position.Z"})
                EXPECT_NEAR(left.at(axis, x, y), right.at(axis, x - 4, y), 1e-5);
            // The same place in the same light, looked at from another side: a diffuse surface.
            EXPECT_NEAR(left.at("irradiance.G", x, y), right.at("irradiance.G", x - 4, y),
                        1e-5 * left.at("irradiance.G", x, y));
        }
    }
}

TEST_F(Rigs, LightIsSplattedOnce) {
    expect_runs({"render", "rig.yaml", "-o", "out.exr", "--stats", "stats.json"});
    const auto frames = nlohmann::json::parse(read("stats.json")).at("frames");
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_GT(frames[0].at("splat_rays"), 0);
    EXPECT_EQ(frames[1].at("splat_rays"), 0);
}

TEST_F(Rigs, LampsAndCamerasMoveWithTheRig) {
    // The whole rig, its world and all, moved by (1, 2, 3): the same images but for rounding.
    const std::string camera = k_camera;
    const auto rig = [&](const std::string& place, const std::string& frame, double x, double z) {
        return "uwvdb: 1\n" + place + "cameras:\n  - {name: a, " + camera + ", " + pose(0.2) +
               "}\n  - {name: b, " + camera + ", " + pose(-0.2) + "}\n" +
               "geometry: [{type: plane, point: [0, 0, " + std::to_string(z) +
               "], normal: [0, 0, -1]}]\nlamps: [{position: [" + std::to_string(x) +
               ", -0.2, 0], direction: [0, 0.3, 1], profile: {type: spot, beam: 50, edge: 10}, "
               "intensity: 20" +
               frame + "}]\n";
    };
    write("at_rest.yaml", rig("", "", 0.5, 4));
    write("moved.yaml",
          rig("rig: {pose: {position: [1, 2, 3], look_at: [1, 2, 4], up: [0, -1, 0]}}\n",
              ", frame: rig", 0.5, 7));
    write("first.yaml", rig("", ", frame: camera", 0.3, 4));
    for (const std::string name : {"at_rest", "moved", "first"})
        expect_runs({"render", name + ".yaml", "-o", name + ".exr", "--layers", "all"});
    for (const std::string camera_name : {"a", "b"}) {
        const ImageFile expected = image("at_rest." + camera_name + ".exr");
        for (const std::string name : {"moved.", "first."}) {
            const ImageFile found = image(name + camera_name + ".exr");
            for (const char* const channel : {"R", "G", "backscatter.B", "depth.Z"})
                for (int y = 0; y < 18; ++y)
                    for (int x = 0; x < 32; ++x)
                        EXPECT_NEAR(found.at(channel, x, y), expected.at(channel, x, y),
                                    2e-5 * std::abs(expected.at(channel, x, y)) + 1e-9)
                            << name << channel;
        }
    }
}

TEST_F(Rigs, OneOfTheCameras) {
    expect_runs({"render", "rig.yaml", "-o", "{camera}.exr", "--camera", "right"});
    EXPECT_FALSE(exists("left.exr"));
    expect_runs({"render", "right.yaml", "-o", "one.exr"});
    expect_same_pixels("right.exr", "one.exr");
    expect_runs({"render", "rig.yaml", "-o", "crop.exr", "--camera", "right", "--crop", "4,4,9,9"});
    EXPECT_EQ(image("crop.right.exr").width, 5);
    expect_failure({"render", "rig.yaml", "--camera", "middle"}, 2,
                   "--camera: the scene has no camera 'middle'; it has left, right");
    expect_failure({"render", "left.yaml", "--camera", "left"}, 2, "has one camera");
    expect_failure({"render", "left.yaml", "-o", "{camera}.exr"}, 2, "take {camera} out");
}

TEST_F(Rigs, CamerasMayDiffer) {
    expect_runs({"render", "rig.yaml", "-o", "out.exr", "--set",
                 "cameras.right.resolution=[20, 10]", "--set",
                 "cameras.right.intrinsics={fov_x: 40}"});
    EXPECT_EQ(image("out.left.exr").width, 32);
    EXPECT_EQ(image("out.right.exr").width, 20);
    expect_runs({"render", "rig.yaml", "-o", "out.exr", "--size", "8x6"});
    EXPECT_EQ(image("out.right.exr").height, 6);
}

TEST_F(Rigs, EachMayHaveItsCalibration) {
    write("camera.yaml",
          "image_width: 32\nimage_height: 18\ncamera_name: a\n"
          "camera_matrix: {rows: 3, cols: 3, data: [40, 0, 16, 0, 40, 9, 0, 0, 1]}\n"
          "distortion_model: plumb_bob\n"
          "distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}\n");
    expect_runs({"render", "rig.yaml", "-o", "out.exr"});
    expect_runs({"render", "rig.yaml", "-o", "from.exr", "--set",
                 "cameras[1]={name: right, calibration: camera.yaml, " + pose(0.4) + "}"});
    // The file's principal point is the image's centre, whether pixel centres are at 0 or 1/2.
    const ImageFile a = image("out.right.exr"), b = image("from.right.exr");
    EXPECT_EQ(b.width, 32);
    EXPECT_NEAR(a.at("depth.Z", 5, 5), b.at("depth.Z", 5, 5), 1e-4);
}

TEST_F(Rigs, InSequences) {
    expect_runs(
        {"render", "rig.yaml", "-o", "{camera}.##.exr", "--frames", "1-2", "--stats", "s.json"});
    for (const char* const name : {"left.01.exr", "left.02.exr", "right.01.exr", "right.02.exr"})
        EXPECT_TRUE(exists(name)) << name;
    std::filesystem::remove(folder_ / "right.02.exr");
    const test::ProgramResult resumed =
        expect_runs({"render", "rig.yaml", "-o", "{camera}.##.exr", "--frames", "1-2", "--resume"});
    EXPECT_NE(resumed.err.find("1 image left"), std::string::npos) << resumed.err;
    EXPECT_TRUE(exists("right.02.exr"));
}

TEST_F(Rigs, WhatIsWrongIsOneLine) {
    const std::string camera = k_camera;
    const auto expect_refused = [&](const std::string& scene, const std::string& says) {
        write("wrong.yaml", "uwvdb: 1\n" + scene);
        expect_failure({"render", "wrong.yaml"}, 3, says);
    };
    const std::string one = "{name: a, " + camera + "}";
    expect_refused("cameras: []\n", "cameras: is empty");
    expect_refused("cameras: [{" + camera + "}]\n", "cameras[0]: 'name' is missing");
    expect_refused("cameras: [{name: a/b, " + camera + "}]\n", "cannot be part of a file's name");
    expect_refused("cameras: [" + one + ", " + one + "]\n", "is taken by another camera");
    expect_refused("cameras: [{name: a, " + camera + ", colour: 3}]\n",
                   "cameras[0].colour: unknown");
    expect_refused("cameras: [" + one + "]\ncamera: {" + camera + "}\n",
                   "either camera or cameras");
    expect_refused("rig: {pose: {look_at: [0, 0, 1]}}\ncamera: {" + camera + "}\n",
                   "rig: a rig has named cameras");
    expect_refused("rig: {}\ncameras: [" + one + "]\n", "rig: 'pose' is missing");
    expect_refused(
        "camera: {" + camera + "}\nlamps: [{position: [0, 0, 0], intensity: 1, frame: rig}]\n",
        "lamps[0].frame: there is no rig");
    expect_refused("cameras: [" + one + "]\nrender: {output: paper}\n", "needs the camera's lens");
}

}  // namespace
}  // namespace uw
