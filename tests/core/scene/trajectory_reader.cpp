// ctest labels: unit
#include "core/scene/trajectory_reader.h"

#include <gtest/gtest.h>

#include "tests/support/scene_errors.h"

namespace uw::test {
namespace {

class TrajectoryKeys : public SceneErrors {
  protected:
    TrajectoryKeys() {
        for (const char* name :
             {"dive.tum", "images.txt", "images.bin", "transforms.json", "poses.csv", "poses.txt"})
            folder_.write(name, "");
    }
    SceneDesc read(const std::string& text) {
        return read_scene(folder_.write("scene.yaml", "uwvdb: 1\n" + text), {});
    }
    TrajectoryDesc camera_trajectory(const std::string& trajectory) {
        return read("camera: {resolution: [64, 48], intrinsics: {fov_x: 60}, trajectory: " +
                    trajectory + "}\n")
            .camera.trajectory.value();
    }
};

TEST_F(TrajectoryKeys, KeyframesHaveThePosesOfCameras) {
    const TrajectoryDesc desc = camera_trajectory(
        "{keyframes: [{time: -1, position: [1, 2, 3], look_at: [5, 2, 3]}, {time: 0.5, position: "
        "[1, 2, 3], rotate: [0, 90, 0]}, {time: 2, matrix: [[0, 0, 1, 1], [0, 1, 0, 2], [-1, 0, 0, "
        "3], [0, 0, 0, 1]]}]}");
    ASSERT_EQ(desc.keyframes.size(), 3U);
    EXPECT_EQ(desc.keyframes[0].time, -1);
    EXPECT_EQ(desc.keyframes[2].time, 2);
    EXPECT_EQ(desc.interpolation, Interpolation::smooth);
    EXPECT_EQ(desc.pacing.kind, Pacing::Kind::given);
    // Looking along x with y up: right is z, down -y.
    const Matrix3 view = desc.keyframes[0].pose.rotation.matrix();
    EXPECT_LT(glm::length(view[0] - Vector3(0, 0, 1)), 1e-15);
    EXPECT_LT(glm::length(view[1] - Vector3(0, -1, 0)), 1e-15);
    // Turned about y by 90 degrees z is x, too, x is -z, and y stays.
    for (const std::size_t turned : {1U, 2U}) {
        const Matrix3 axes = desc.keyframes[turned].pose.rotation.matrix();
        EXPECT_LT(glm::length(axes[2] - Vector3(1, 0, 0)), 1e-15);
        EXPECT_LT(glm::length(axes[1] - Vector3(0, 1, 0)), 1e-15);
        EXPECT_EQ(desc.keyframes[turned].pose.position, (Point3{1, 2, 3}));
    }
}

TEST_F(TrajectoryKeys, FilesTellTheirFormatByTheirNames) {
    EXPECT_EQ(camera_trajectory("{file: dive.tum}").format, PoseFormat::tum);
    EXPECT_EQ(camera_trajectory("{file: poses.csv}").format, PoseFormat::euroc);
    EXPECT_EQ(camera_trajectory("{file: images.txt}").format, PoseFormat::colmap);
    EXPECT_EQ(camera_trajectory("{file: transforms.json}").format, PoseFormat::nerfstudio);
    EXPECT_EQ(camera_trajectory("{file: poses.txt, format: tum}").format, PoseFormat::tum);
    const TrajectoryDesc desc = camera_trajectory(
        "{file: dive.tum, start: 1311868164.5, interpolation: linear, speed: constant, transform: "
        "{scale: 2, rotate: [-90, 0, 0], translate: [1, 2, 3]}}");
    EXPECT_EQ(desc.start, 1311868164.5);
    EXPECT_EQ(desc.interpolation, Interpolation::linear);
    EXPECT_EQ(desc.pacing.kind, Pacing::Kind::constant);
    EXPECT_NEAR(desc.scale, 2, 1e-15);
    // z up becomes y up.
    EXPECT_LT(distance(desc.world_from_file * Point3{0, 0, 1}, {1, 3, 3}), 1e-15);
}

TEST_F(TrajectoryKeys, ASpeedSetsTheTimes) {
    const TrajectoryDesc desc = camera_trajectory(
        "{speed: 0.5, keyframes: [{position: [0, 0, 0], rotate: [0, 0, 0]}, {position: [1, 0, 0], "
        "rotate: [0, 0, 0]}]}");
    EXPECT_EQ(desc.pacing, (Pacing{Pacing::Kind::speed, 0.5}));
    EXPECT_EQ(desc.keyframes[0].time, 0);
}

TEST_F(TrajectoryKeys, MoveCamerasRigsLampsAndGeometry) {
    const SceneDesc scene = read(
        "rig: {trajectory: {file: dive.tum}}\n"
        "cameras: [{name: a, resolution: [4, 3], intrinsics: {fov_x: 60}, pose: {position: [1, 0, "
        "0], look_at: [1, 0, 1], up: [0, -1, 0]}}]\n"
        "lamps: [{position: [0, 1, 0], intensity: 1}, {position: [0, 1, 0], intensity: 1, frame: "
        "world}, {intensity: 1, trajectory: {keyframes: [{time: 0, position: [0, 2, 0]}]}}]\n"
        "geometry: [{type: sphere, center: [0, 0, 0], radius: 1, trajectory: {file: dive.tum}}]\n");
    EXPECT_TRUE(scene.rig_trajectory);
    // Until there is a moment, in the rig's axes.
    EXPECT_EQ(scene.cameras[0].camera.world_from_camera.offset(), Vector3(1, 0, 0));
    EXPECT_TRUE(scene.lamps[0].fixed_to_rig);
    EXPECT_FALSE(scene.lamps[1].fixed_to_rig);
    EXPECT_TRUE(scene.lamps[2].trajectory);
    EXPECT_EQ(scene.lamps[2].position, Point3());
    EXPECT_FALSE(scene.lamps[2].fixed_to_camera || scene.lamps[2].fixed_to_rig);
    EXPECT_TRUE(scene.geometry[0].trajectory);
}

TEST_F(TrajectoryKeys, FaultsSayWhereAndWhat) {
    const std::string camera =
        "uwvdb: 1\ncamera: {resolution: [64, 48], intrinsics: {fov_x: 60}, trajectory: ";
    check(
        camera,
        {{"{}}", "camera.trajectory: has neither a file nor keyframes"},
         {"{keyframes: []}}", "camera.trajectory.keyframes: is empty"},
         {"{keyframes: [{position: [0, 0, 0], look_at: [0, 0, 1]}]}}",
          "camera.trajectory.keyframes[0]: 'time' is missing"},
         {"{keyframes: [{time: 0, position: [0, 0, 0]}]}}",
          "camera.trajectory.keyframes[0]: 'look_at' is missing"},
         {"{keyframes: [{time: 0, rotate: [0, 0, 0], look_at: [0, 0, 1]}]}}",
          "camera.trajectory.keyframes[0].look_at: "},
         {"{keyframes: [{time: 1, rotate: [0, 0, 0]}, {time: 1, rotate: [0, 0, 0]}]}}",
          "camera.trajectory.keyframes[1]: its time of 1 s is not after that of the one before"},
         {"{keyframes: [{time: .nan, rotate: [0, 0, 0]}]}}", "keyframes[0].time: "},
         {"{speed: constant, keyframes: [{time: 2, rotate: [0, 0, 0]}, {time: 1, position: [1, 0, "
          "0], rotate: [0, 0, 0]}]}}",
          "keyframes[1]: its time of 1 s is not after that of the first"},
         {"{speed: 1, keyframes: [{rotate: [0, 0, 0]}, {time: 1, rotate: [0, 0, 0]}]}}",
          "keyframes[1].time: follows from 'speed'"},
         {"{speed: 1, keyframes: [{rotate: [0, 0, 0]}, {rotate: [0, 9, 0]}]}}",
          "keyframes[1]: has the position of the keyframe before"},
         {"{speed: 0, keyframes: [{rotate: [0, 0, 0]}]}}", "camera.trajectory.speed: "},
         {"{file: none.tum}}", "camera.trajectory.file: "},
         {"{file: poses.txt}}", "camera.trajectory.file: its name does not say"},
         {"{file: images.txt, start: 3}}", "trajectory.start: files of this format have no times"},
         {"{file: dive.tum, keyframes: []}}", "keyframes: a trajectory has either"},
         {"{file: dive.tum, transform: {scale: [1, 2, 1]}}}", "transform: the scale of a"},
         {"{file: dive.tum, transform: {scale: -1}}}", "transform: the scale of a"},
         {"{start: 1, keyframes: [{time: 0, rotate: [0, 0, 0]}]}}", "camera.trajectory.start: "},
         {"{file: dive.tum}, pose: {position: [0, 0, 0], look_at: [0, 0, 1]}}",
          "camera.trajectory: a camera has either a pose or a trajectory"}});
    check("uwvdb: 1\n",
          {{"cameras: [{name: a, resolution: [4, 3], intrinsics: {fov_x: 60}, trajectory: {file: "
            "dive.tum}}]\n",
            "cameras[0].trajectory: the cameras of a rig are fixed to it"},
           {"rig: {trajectory: {file: dive.tum}, pose: {position: [0, 0, 0], look_at: [0, 0, 1]}}\n"
            "cameras: [{name: a, resolution: [4, 3], intrinsics: {fov_x: 60}}]\n",
            "rig.pose: "}});
    check(k_base, {{"render: {fps: 0}\n", "render.fps: "},
                   {"render: {times: trajectory}\n", "render.times: needs camera.trajectory"},
                   {"render: {times: never}\n", "render.times: "},
                   {"lamps: [{intensity: 1, frame: camera, trajectory: {file: dive.tum}}]\n",
                    "lamps[0].frame: a lamp with a trajectory of its own"}});
}

}  // namespace
}  // namespace uw::test
