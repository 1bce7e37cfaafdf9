// ctest labels: metamorphic
#include <gtest/gtest.h>

#include "core/scene/pose_file.h"
#include "tests/support/dataset/dataset_scenes.h"
#include "tests/support/meshes/vehicle_gltf.h"

namespace uw {
namespace {

using BlenderCamera = test::DatasetTest;

// An animated camera as Blender exports it, against its matrix_world in Blender; and once more
// after the set's poses have become a trajectory.
TEST_F(BlenderCamera, HasItsPosesInEveryFormat) {
    write("vehicle.gltf", test::vehicle_gltf());
    write("eye.yaml",
          "uwvdb: 1\ncamera: {resolution: [32, 18]}\nwater: {absorption: 0.1}\n"
          "geometry: [{file: vehicle.gltf, camera: Eye, lamps: all}]\n"
          "render: {samples: 1, fps: 24}\n");
    const auto expect_blenders = [&](const char* set) {
        const auto expect = [&](const char* file, PoseFormat format, double times) {
            SCOPED_TRACE(file);
            const std::vector<TimedPose> poses =
                read_pose_file(folder_ / set / file, format, "test").poses;
            ASSERT_EQ(poses.size(), 13U);
            for (const test::VehicleFrame& blender : test::k_vehicle_frames) {
                const TimedPose& timed = poses[static_cast<std::size_t>(blender.frame)];
                EXPECT_NEAR(timed.time, blender.frame / times, 1e-6);
                const Matrix3 axes = timed.pose.rotation.matrix();
                for (int row = 0; row < 3; ++row) {
                    const std::array<double, 4>& eye = blender.eye[static_cast<std::size_t>(row)];
                    // Cameras of glTF look along -z with y up; its numbers have 24 bits.
                    EXPECT_NEAR(axes[0][row], eye[0], 1e-6);
                    EXPECT_NEAR(axes[1][row], -eye[1], 1e-6);
                    EXPECT_NEAR(axes[2][row], -eye[2], 1e-6);
                    EXPECT_NEAR(timed.pose.position[row], eye[3], 1e-6);
                }
            }
        };
        expect("tum/groundtruth.txt", PoseFormat::tum, 24);
        expect("mav0/state_groundtruth_estimate0/data.csv", PoseFormat::euroc, 24);
        expect("sparse/0/images.txt", PoseFormat::colmap, 1);
        expect("transforms.json", PoseFormat::nerfstudio, 1);
    };
    const std::string formats = "colmap,nerfstudio,tum,euroc";
    make("eye.yaml", formats, {"--frames", "0-12"});
    expect_blenders("set");
    const auto result =
        run({"dataset", "eye.yaml", "-o", "back", "--format", formats, "--frames", "0-12", "--set",
             "camera.trajectory={file: set/transforms.json}", "--set",
             "geometry=[{file: vehicle.gltf, lamps: all}]", "--set",
             "camera.intrinsics={fov_x: 45}", "--set", "render.times=trajectory", "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    expect_blenders("back");
}

}  // namespace
}  // namespace uw
