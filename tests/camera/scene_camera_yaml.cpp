// ctest labels: unit metamorphic
#include <gtest/gtest.h>

#include "camera/calibration.h"
#include "core/scene/scene_desc.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

/// What the scene's own reader makes of a camera that was written.
CameraDesc read_as_scene(const CameraDesc& camera) {
    const test::SceneFolder folder;
    return read_scene(folder.write("s.yaml", "uwvdb: 1\n" + write_scene_camera(camera)), {}).camera;
}

CameraDesc camera_with_digits() {
    CameraDesc camera;
    camera.width = 641;
    camera.height = 479;
    camera.intrinsics = {500.1, 1501.0 / 3, 320.7, 0.1 + 0.2};
    return camera;
}

TEST(SceneCameraYaml, KeepsAllDigits) {
    const CameraDesc camera = camera_with_digits(), again = read_as_scene(camera);
    EXPECT_EQ(again.width, camera.width);
    EXPECT_EQ(again.height, camera.height);
    EXPECT_EQ(again.intrinsics.fx, camera.intrinsics.fx);
    EXPECT_EQ(again.intrinsics.fy, camera.intrinsics.fy);
    EXPECT_EQ(again.intrinsics.cx, camera.intrinsics.cx);
    EXPECT_EQ(again.intrinsics.cy, camera.intrinsics.cy);
    EXPECT_FALSE(again.port);
    EXPECT_EQ(write_scene_camera(camera).find("distortion"), std::string::npos);
}

TEST(SceneCameraYaml, HasDistortionOfAnyLength) {
    for (const std::size_t count : {1U, 3U, 6U}) {
        CameraDesc camera = camera_with_digits();
        for (std::size_t i = 0; i < count; ++i) camera.distortion.k[i] = 0.01 * double(i + 1);
        camera.distortion.p = {0.001, -0.002};
        const CameraDesc again = read_as_scene(camera);
        EXPECT_EQ(again.distortion.k, camera.distortion.k);
        EXPECT_EQ(again.distortion.p, camera.distortion.p);
    }
    CameraDesc fisheye = camera_with_digits();
    fisheye.distortion.model = DistortionDesc::Model::fisheye;
    fisheye.distortion.k = {0.1, 0.01, 0.001, 0.0001, 0, 0};
    EXPECT_EQ(read_as_scene(fisheye).distortion.model, DistortionDesc::Model::fisheye);
    EXPECT_EQ(read_as_scene(fisheye).distortion.k, fisheye.distortion.k);
}

TEST(SceneCameraYaml, HasPorts) {
    CameraDesc camera = camera_with_digits();
    FlatPortDesc flat;
    flat.normal = {0, 0.6, 0.8};
    flat.distance = 0.0123;
    flat.thickness = 0.01;
    flat.n_glass = 1.473;
    flat.fresnel = true;
    camera.port = flat;
    const auto flat_again = std::get<FlatPortDesc>(read_as_scene(camera).port.value());
    EXPECT_EQ(flat_again.normal, flat.normal);
    EXPECT_EQ(flat_again.distance, flat.distance);
    EXPECT_EQ(flat_again.n_glass, flat.n_glass);
    EXPECT_TRUE(flat_again.fresnel);
    DomePortDesc dome;
    dome.center = {0.001, -0.002, 0.003};
    dome.radius = 0.06;
    dome.thickness = 0.005;
    dome.n_water = 1.341;
    camera.port = dome;
    const auto dome_again = std::get<DomePortDesc>(read_as_scene(camera).port.value());
    EXPECT_EQ(dome_again.center, dome.center);
    EXPECT_EQ(dome_again.radius, dome.radius);
    EXPECT_EQ(dome_again.thickness, dome.thickness);
    EXPECT_EQ(dome_again.n_water, dome.n_water);
}

}  // namespace
}  // namespace uw
