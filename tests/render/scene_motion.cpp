// ctest labels: unit analytic
#include "render/image_scene.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "render/renderer.h"
#include "render/scene_loading.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/meshes/vehicle_gltf.h"
#include "tests/support/message_of.h"
#include "tests/support/scene_folder.h"

namespace uw::test {
namespace {

/// Straight along x at 1 m/s from 0 s to 2 s, looking along z with y down.
constexpr const char* k_ahead =
    "{interpolation: linear, keyframes: [{time: 0, rotate: [0, 0, 0]}, {time: 2, position: [2, 0, "
    "0], rotate: [0, 0, 0]}]}";

class Motion : public testing::Test {
  protected:
    SceneDesc load(const std::string& text) const {
        return load_scene(folder_.write("scene.yaml", "uwvdb: 1\n" + text), {});
    }
    SceneDesc load_camera(const std::string& trajectory, const std::string& rest = "") const {
        return load("camera: {resolution: [8, 6], intrinsics: {fov_x: 60}, trajectory: " +
                    trajectory + "}\n" + rest);
    }
    SceneFolder folder_;
};

Vector3 camera_place(const ImageScene& scene) {
    return scene.desc().camera.world_from_camera.offset();
}

TEST_F(Motion, AFrameIsAtItsNumberOverTheFrameRate) {
    const SceneDesc scene = load_camera(k_ahead);
    EXPECT_TRUE(has_motion(scene));
    EXPECT_EQ(time_of_frame(scene, 10), 10 / 25.0);
    EXPECT_EQ(frames_of(scene)->first, 0);
    EXPECT_EQ(frames_of(scene)->last, 50);
    EXPECT_NEAR(camera_place(scene_of_image(scene, {10})).x, 0.4, 1e-15);
    EXPECT_EQ(scene_of_image(scene, {10}).time(), 0.4);
    const SceneDesc slow = load_camera(k_ahead, "render: {fps: 2}\n");
    EXPECT_NEAR(camera_place(scene_of_image(slow, {3})).x, 1.5, 1e-15);
    EXPECT_EQ(frames_of(slow)->last, 4);
    EXPECT_FALSE(has_motion(load("camera: {resolution: [8, 6], intrinsics: {fov_x: 60}}\n")));
}

TEST_F(Motion, WithoutAFrameItIsTheFirstMoment) {
    const std::string late =
        "{keyframes: [{time: 3, position: [3, 0, 0], rotate: [0, 0, 0]}, {time: 4, position: [4, "
        "0, 0], rotate: [0, 0, 0]}]}";
    const SceneDesc scene = load_camera(late);
    EXPECT_EQ(first_time(scene), 3);
    EXPECT_EQ(camera_place(scene_of_image(scene, {})).x, 3);
    EXPECT_EQ(camera_place(load_camera(late)).x, 3);
    const SceneDesc early = load_camera(
        "{interpolation: linear, keyframes: [{time: -1, rotate: [0, 0, 0]}, {time: 1, position: "
        "[2, 0, 0], rotate: [0, 0, 0]}]}");
    EXPECT_NEAR(camera_place(scene_of_image(early, {})).x, 1, 1e-15);
}

TEST_F(Motion, FramesWithoutAPoseAreRefusedWithThoseThatHaveOne) {
    const SceneDesc scene = load_camera(k_ahead);
    const std::string message = message_of<InputError>([&] { scene_of_image(scene, {51}); });
    EXPECT_NE(message.find("camera.trajectory: has no pose for frame 51, at 2.04 s; its poses are "
                           "from 0 to 2 s, which is frames 0-50"),
              std::string::npos)
        << message;
}

TEST_F(Motion, FramesMayBeTheTrajectorysOwnPoses) {
    const std::filesystem::path file = folder_.write(
        "dive.tum",
        "100.5 0 0 0 0 0 0 1\n100.75 1 0 0 0 0 0 1\n102 5 0 0 0 0 0 1\n103 7 1 0 0 0 0 1\n");
    const SceneDesc scene = load_camera(
        "{file: dive.tum}",
        "render: {times: trajectory}\nlamps: [{intensity: 1, trajectory: {file: dive.tum, start: "
        "101, interpolation: linear}}]\n");
    // The lamp's poses begin half a second earlier on the scene's clock, and end there.
    EXPECT_EQ(frames_of(scene)->first, 0);
    EXPECT_EQ(frames_of(scene)->last, 2);
    const ImageScene third = scene_of_image(scene, {2});
    EXPECT_EQ(third.time(), 1.5);
    EXPECT_EQ(camera_place(third).x, 5);
    EXPECT_NEAR(third.desc().lamps[0].world_from_mount.offset().x, 6, 1e-12);
    EXPECT_NE(message_of<InputError>([&] {
                  scene_of_image(scene, {4});
              }).find("render.times: there is no frame 4; the trajectory has the poses 0-3"),
              std::string::npos);
    // At 2.5 s, which is 103.5 on the lamp's clock.
    EXPECT_NE(message_of<InputError>([&] {
                  scene_of_image(scene, {3});
              }).find("lamps[0].trajectory: has no pose for frame 3, at 2.5 s"),
              std::string::npos);
    // A trajectory's file is an input whose content is in the hash.
    SideFiles known;
    const std::vector<InputFile> inputs = input_files(scene, {}, known);
    const auto found = std::ranges::find(inputs, file, &InputFile::file);
    ASSERT_NE(found, inputs.end());
    EXPECT_TRUE(found->is_hashed);
    folder_.write("dive.tum", "0 0 0 0 0 0 0 1\n9 1 0 0 0 0 0 1\n");
    EXPECT_NE(load_camera("{file: dive.tum}").hash, scene.hash);
}

TEST_F(Motion, PosesWithoutTimesAreThoseOfTheFrames) {
    folder_.write("images.txt", "1 1 0 0 0 -3 0 0 1 f003.png\n\n2 1 0 0 0 -7 0 0 1 f007.png\n\n");
    const SceneDesc scene = load_camera(
        "{file: images.txt, transform: {scale: 2, translate: [0, "
        "1, 0]}}",
        "render: {fps: 10}\n");
    EXPECT_EQ(frames_of(scene)->first, 3);
    EXPECT_EQ(frames_of(scene)->last, 7);
    EXPECT_NEAR(camera_place(scene_of_image(scene, {7})).x, 14, 1e-12);
    EXPECT_NEAR(camera_place(scene_of_image(scene, {7})).y, 1, 1e-12);
}

TEST_F(Motion, ARigCarriesItsCamerasAndLamps) {
    // It turns about y by 90 degrees while it rises: z becomes x, x becomes -z.
    const SceneDesc scene = load(
        "rig: {trajectory: {keyframes: [{time: 0, rotate: [0, 0, 0]}, {time: 1, position: [0, 1, "
        "0], rotate: [0, 90, 0]}]}}\n"
        "cameras:\n"
        "  - {name: l, resolution: [8, 6], intrinsics: {fov_x: 60}}\n"
        "  - {name: r, resolution: [8, 6], intrinsics: {fov_x: 60}, pose: {position: [1, 0, 0], "
        "rotate: [0, 0, 0]}}\n"
        "lamps: [{position: [0, 0, 2], intensity: 1}, {position: [0, 0, 2], intensity: 1, frame: "
        "camera}, {position: [0, 0, 2], intensity: 1, frame: world}]\n");
    const ImageScene of_right = scene_of_image(scene, {25, 1});
    const SceneDesc& right = of_right.desc();
    EXPECT_LT(glm::length(camera_place(of_right) - Vector3(0, 1, -1)), 1e-14);
    EXPECT_LT(glm::length(right.cameras[0].camera.world_from_camera.offset() - Vector3(0, 1, 0)),
              1e-14);
    const auto lamp_place = [&](std::size_t lamp) {
        return right.lamps[lamp].world_from_mount * right.lamps[lamp].position;
    };
    EXPECT_LT(distance(lamp_place(0), {2, 1, 0}), 1e-14);
    EXPECT_LT(distance(lamp_place(1), {2, 1, 0}), 1e-14);
    EXPECT_LT(distance(lamp_place(2), {0, 0, 2}), 1e-14);
    // Fixed to the rig, a lamp stays where it is in every camera.
    const ImageScene of_first = scene_of_image(scene, {0, 1});
    const SceneDesc& first = of_first.desc();
    EXPECT_LT(distance(right.camera.world_from_camera.inverse() * lamp_place(0),
                       first.camera.world_from_camera.inverse() *
                           (first.lamps[0].world_from_mount * first.lamps[0].position)),
              1e-14);
}

/// The distance of the first surface along z from (x, y, 0).
double depth_at(const SceneDesc& scene, int frame, double x, double y) {
    Renderer renderer;
    renderer.set_scene(scene_of_image(scene, {frame}));
    return renderer.assemble().surfaces->hit_distance({{x, y, 0}, {0, 0, 1}});
}

TEST_F(Motion, GeometryMovesAfterItsTransform) {
    folder_.write("box.gltf", gltf_text({}));
    for (const std::string object :
         {"{type: box, min: [-0.1, -0.1, 3], max: [0.1, 0.1, 4], trajectory: ",
          "{type: sphere, center: [0, 0, 3.5], radius: 0.5, trajectory: "}) {
        const SceneDesc scene =
            load("camera: {resolution: [8, 6], intrinsics: {fov_x: 60}}\ngeometry: [" + object +
                 k_ahead + "}]\n");
        EXPECT_NEAR(depth_at(scene, 0, 0, 0), 3, 1e-6);
        EXPECT_NEAR(depth_at(scene, 25, 1, 0), 3, 1e-6);
        EXPECT_GT(depth_at(scene, 25, 0, 0), 100);
    }
    const SceneDesc plane = load(
        "camera: {resolution: [8, 6], intrinsics: {fov_x: 60}}\n"
        "geometry: [{type: plane, point: [0, 0, 5], normal: [0, 0, -1], trajectory: {keyframes: "
        "[{time: 0}, {time: 1, position: [0, 0, 2]}]}}]\n");
    EXPECT_NEAR(depth_at(plane, 25, 0, 0), 7, 1e-12);
}

TEST_F(Motion, NodesOfGltfFilesMoveWithTheFrames) {
    folder_.write("vehicle.gltf", vehicle_gltf());
    const SceneDesc scene = load(
        "camera: {resolution: [64, 36]}\n"
        "geometry: [{file: vehicle.gltf, camera: true, lamps: all}]\nrender: {fps: 24}\n");
    EXPECT_TRUE(has_motion(scene));
    EXPECT_EQ(frames_of(scene)->first, 0);
    EXPECT_EQ(frames_of(scene)->last, 12);
    for (const VehicleFrame& frame : k_vehicle_frames) {
        const ImageScene image = scene_of_image(scene, {frame.frame});
        const Affine& pose = image.desc().camera.world_from_camera;
        const LampDesc& lamp = image.desc().lamps.at(0);
        for (int i = 0; i < 3; ++i) {
            const auto& row = frame.eye[static_cast<std::size_t>(i)];
            // y and z are turned from glTF's camera to ours.
            EXPECT_NEAR(pose.linear()[0][i], row[0], 1e-6);
            EXPECT_NEAR(pose.linear()[1][i], -row[1], 1e-6);
            EXPECT_NEAR(pose.linear()[2][i], -row[2], 1e-6);
            EXPECT_NEAR(pose.offset()[i], row[3], 1e-6);
            EXPECT_NEAR(lamp.position[i], frame.torch[static_cast<std::size_t>(i)][3], 1e-6);
            EXPECT_NEAR(lamp.direction[i], -frame.torch[static_cast<std::size_t>(i)][2], 1e-6);
        }
    }
    // Files of a sequence are each of one moment.
    folder_.write("vehicle_0003.gltf", vehicle_gltf());
    const SceneDesc sequence = load(
        "camera: {resolution: [64, 36]}\n"
        "geometry: [{file: 'vehicle_####.gltf', camera: true}]\n");
    EXPECT_FALSE(has_motion(sequence));
    EXPECT_FALSE(scene_of_image(sequence, {3}).desc().geometry[0].time);
}

/// Blender's frames are 1/24 s apart in this file, which the format does not say.
TEST_F(Motion, AtAnotherRateThanItsGltfFileIsWarnedOf) {
    folder_.write("vehicle.gltf", vehicle_gltf());
    const auto warnings = [&](const char* render) {
        auto all = load(std::string("camera: {resolution: [64, 36]}\n"
                                    "geometry: [{file: vehicle.gltf, camera: true}]\n") +
                        render)
                       .warnings;
        std::erase_if(all, [](const std::string& line) {  // of a scene without water and lamps
            return line.find("render.fps") == std::string::npos;
        });
        return all;
    };
    const auto said = warnings("");  // 25 by default
    ASSERT_EQ(said.size(), 1U);
    EXPECT_NE(said.front().find("geometry[0].file: "), std::string::npos) << said.front();
    EXPECT_NE(said.front().find("vehicle.gltf: its keys are those of frames at 24 per second, but "
                                "render.fps is 25, so that frame n is not the file's frame n; give "
                                "render.fps: 24"),
              std::string::npos)
        << said.front();
    EXPECT_TRUE(warnings("render: {fps: 24}\n").empty());
    EXPECT_TRUE(warnings("render: {fps: 48}\n").empty());  // each of the file's, and one between
    EXPECT_EQ(warnings("render: {fps: 30}\n").size(), 1U);
}

/// While a frame is exposed: at the time of another frame everything is where that one has it.
TEST_F(Motion, GoesOnWhileAFrameIsExposed) {
    folder_.write("vehicle.gltf", vehicle_gltf());
    const auto check = [](const SceneDesc& scene) {
        const ImageScene shown = scene_of_image(scene, {2});
        for (const int frame : {0, 5, 12}) {
            const ImageScene other = scene_of_image(scene, {frame});
            const ImageScene moved = shown.at(*other.time());
            const SceneDesc& then = moved.desc();
            EXPECT_EQ(then.camera.world_from_camera, other.desc().camera.world_from_camera);
            EXPECT_NE(then.camera.world_from_camera, shown.desc().camera.world_from_camera);
            EXPECT_EQ(then.geometry, other.desc().geometry);
            ASSERT_EQ(then.lamps.size(), other.desc().lamps.size());
            for (std::size_t j = 0; j < then.lamps.size(); ++j) {
                EXPECT_EQ(then.lamps[j].position, other.desc().lamps[j].position);
                EXPECT_EQ(then.lamps[j].direction, other.desc().lamps[j].direction);
                EXPECT_EQ(then.lamps[j].world_from_mount, other.desc().lamps[j].world_from_mount);
            }
        }
    };
    check(
        load("camera: {resolution: [64, 36]}\n"
             "geometry: [{file: vehicle.gltf, camera: true, lamps: all}]\nrender: {fps: 24}\n"));
    const std::string lamp = "direction: [0, 0, 1], profile: {type: isotropic}, power: [1, 1, 1]}";
    check(
        load("cameras: [{name: left, resolution: [8, 6], intrinsics: {fov_x: 60}, pose: {position: "
             "[0.1, 0, 0], rotate: [0, 0, 0]}}]\n"
             "rig: {trajectory: " +
             std::string(k_ahead) +
             "}\n"
             "geometry: [{type: sphere, center: [0, 0, 3], radius: 1, trajectory: " +
             k_ahead +
             "}]\n"
             "lamps: [{name: a, frame: rig, position: [1, 0, 0], " +
             lamp + ", {name: b, position: [0, 1, 0], " + lamp +
             ", {name: c, trajectory: " + k_ahead + ", " + lamp + "]\n"));
}

// What stands still is kept from frame to frame.
TEST_F(Motion, OnlyWhatMovesIsMadeAnew) {
    const std::string rest =
        "geometry: [{type: box, min: [-1, -1, 3], max: [1, 1, 4]}]\n"
        "lamps: [{position: [0, 1, 0], intensity: 1, frame: world}]\n";
    const SceneDesc scene = load_camera(k_ahead, rest);
    Renderer renderer;
    renderer.set_scene(scene_of_image(scene, {0}));
    renderer.render();
    const Surfaces* const surfaces = renderer.assembled().surfaces.get();
    renderer.set_scene(scene_of_image(scene, {1}));
    renderer.render();
    EXPECT_EQ(renderer.assembled().surfaces.get(), surfaces);
    EXPECT_EQ(renderer.report().splat_rays, 0U);
}

}  // namespace
}  // namespace uw::test
