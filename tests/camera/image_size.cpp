// ctest labels: unit metamorphic
#include "camera/camera.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

CameraDesc camera_of_640_by_480() {
    CameraDesc camera;
    camera.width = 640;
    camera.height = 480;
    camera.intrinsics = {500, 510, 315, 245};
    return camera;
}

TEST(ImageSize, EachPartOfThePictureKeepsItsRay) {
    const CameraDesc camera = camera_of_640_by_480();
    CameraDesc resized = camera;
    resize_image(resized, 160, 360);  // a quarter across, three quarters down
    EXPECT_EQ(resized.width, 160);
    EXPECT_EQ(resized.height, 360);
    const Camera a(camera), b(resized);
    for (double y = 0; y <= 1; y += 0.25)
        for (double x = 0; x <= 1; x += 0.25) {
            const auto ray = a.refracted_ray(640 * x, 480 * y);
            const auto same = b.refracted_ray(160 * x, 360 * y);
            EXPECT_LT(glm::length(ray.value().direction - same.value().direction), 1e-15);
        }
}

TEST(ImageSize, ThereAndBackIsTheSameCamera) {
    CameraDesc camera = camera_of_640_by_480();
    resize_image(camera, 1280, 120);
    EXPECT_EQ(camera.intrinsics.fx, 1000);
    EXPECT_EQ(camera.intrinsics.cy, 61.25);
    resize_image(camera, 640, 480);
    EXPECT_EQ(camera.intrinsics.fx, 500);
    EXPECT_EQ(camera.intrinsics.fy, 510);
    EXPECT_EQ(camera.intrinsics.cx, 315);
    EXPECT_EQ(camera.intrinsics.cy, 245);
}

}  // namespace
}  // namespace uw
