// ctest labels: unit
#include "core/scene/trajectory_reader.h"

#include <gtest/gtest.h>

#include <string>

#include "core/scene/scene_desc.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

Affine read_pose(const std::string& pose) {
    const test::SceneFolder folder;
    return read_scene(folder.write("scene.yaml",
                                   "uwvdb: 1\ncamera: {resolution: [4, 3], intrinsics: {fov_x: "
                                   "90}, pose: " +
                                       pose + "}\n"),
                      {})
        .camera.world_from_camera;
}

void expect_near(const Vector3& found, const Vector3& expected, double tolerance) {
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(found[axis], expected[axis], tolerance) << "axis " << axis;
    }
}

TEST(ScenePose, lookAtMakesARightHandedCameraWithUpUp) {
    const Affine pose = read_pose("{position: [5, 1, -2], look_at: [1, 0, 3]}");
    const Vector3 right = pose.apply_to_vector({1, 0, 0});
    const Vector3 down = pose.apply_to_vector({0, 1, 0});
    const Vector3 forward = pose.apply_to_vector({0, 0, 1});
    // laws of a rigid, right-handed frame, to rounding
    expect_near(forward, glm::normalize(Vector3(-4, -1, 5)), 1e-15);
    EXPECT_NEAR(pose.determinant(), 1, 1e-14);
    EXPECT_NEAR(glm::dot(right, down), 0, 1e-15);
    EXPECT_NEAR(glm::length(down), 1, 1e-15);
    EXPECT_NEAR(right.y, 0, 1e-15) << "no roll: right is horizontal in a y-up world";
    EXPECT_LT(down.y, 0) << "down is down";
    expect_near(pose.offset(), {5, 1, -2}, 0);
}

TEST(ScenePose, lookingNorthInAYUpWorldHasEastAtItsRight) {
    // y up, looking along -z: x is right (as in glTF); exact, all axes
    const Affine pose = read_pose("{look_at: [0, 0, -1]}");
    expect_near(pose.apply_to_vector({1, 0, 0}), {1, 0, 0}, 0);
    expect_near(pose.apply_to_vector({0, 1, 0}), {0, -1, 0}, 0);
    expect_near(pose.apply_to_vector({0, 0, 1}), {0, 0, -1}, 0);
}

TEST(ScenePose, upNeedNotBeSquareToTheView) {
    // only the part of `up` across the view counts
    const Affine slanted = read_pose("{look_at: [0, 0, 1], up: [0, -1, 5]}");
    expect_near(slanted.apply_to_vector({0, 1, 0}), {0, 1, 0}, 1e-15);
}

TEST(ScenePose, readsAMatrixByRows) {
    // camera x, y, z are world -z, -y, -x: (-z) x (-y) = -x, right-handed
    const Affine pose =
        read_pose("{matrix: [[0, 0, -1, 7], [0, -1, 0, 8], [-1, 0, 0, 9], [0, 0, 0, 1]]}");
    expect_near(pose.apply_to_vector({0, 0, 1}), {-1, 0, 0}, 0);
    expect_near(from_origin(pose * Point3{0, 0, 2}), {5, 8, 9}, 0);
}

}  // namespace
}  // namespace uw
