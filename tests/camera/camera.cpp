// ctest labels: unit analytic
#include "camera/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace uw {
namespace {

CameraDesc pinhole() {
    CameraDesc desc;
    desc.width = 640;
    desc.height = 480;
    desc.intrinsics = {500, 510, 320, 240};
    return desc;
}

CameraDesc behind_port() {
    CameraDesc desc = pinhole();
    desc.port = FlatPortDesc{};
    std::get<FlatPortDesc>(*desc.port).distance = 0.02;
    std::get<FlatPortDesc>(*desc.port).thickness = 0.04;
    return desc;
}

/// How much farther from the centre than a camera without housing image position `x` shows what
/// it sees in the plane z = `depth`.
double enlargement(const Camera& camera, double x, double depth) {
    const auto ray = camera.refracted_ray(x, 240);
    EXPECT_TRUE(ray);
    if (!ray) return 0;
    const Point3 seen = ray->at((depth - ray->origin.z) / ray->direction.z);
    const double bare = 500 * seen.x / seen.z;
    return (x - 320) / bare;
}

TEST(Camera, ImageCornerIsZeroAndPixelCentresAtOneHalf) {
    CameraDesc desc = pinhole();
    desc.width = 2;
    desc.height = 2;
    desc.intrinsics = {1, 1, 1, 1};  // the principal point is the corner shared by all four pixels
    const Camera camera(desc);
    const auto axis = camera.refracted_ray(1, 1);
    ASSERT_TRUE(axis);
    EXPECT_EQ(axis->direction, Vector3(0, 0, 1));
    const auto first = camera.refracted_ray(0.5, 0.5);  // up and left: x right, y down
    ASSERT_TRUE(first);
    const Vector3 truth = Vector3(-0.5, -0.5, 1) / std::sqrt(1.5);
    EXPECT_NEAR(glm::length(first->direction - truth), 0, 1e-15);
}

TEST(Camera, PinholeWithoutPortStartsAtTheCentre) {
    const Camera camera(pinhole());
    const auto ray = camera.refracted_ray(420, 342);
    ASSERT_TRUE(ray);
    EXPECT_EQ(ray->origin, (Point3{0, 0, 0}));
    EXPECT_NEAR(ray->direction.x / ray->direction.z, 0.2, 1e-15);
    EXPECT_NEAR(ray->direction.y / ray->direction.z, 0.2, 1e-15);
    EXPECT_EQ(camera.width(), 640);
    EXPECT_EQ(camera.height(), 480);
}

TEST(Camera, PoseTurnsAndMovesTheRay) {
    CameraDesc desc = behind_port();
    // Looks along world x: camera z -> x, camera x -> -z, camera y -> y.
    desc.world_from_camera = {Matrix3(0, 0, -1, 0, 1, 0, 1, 0, 0), Vector3(10, 20, 30)};
    const auto ray = Camera(desc).refracted_ray(320, 240);
    ASSERT_TRUE(ray);
    EXPECT_NEAR(ray->origin.x, 10.06, 1e-14);  // on the outer glass surface
    EXPECT_NEAR(ray->origin.y, 20, 1e-14);
    EXPECT_NEAR(ray->origin.z, 30, 1e-14);
    EXPECT_NEAR(glm::length(ray->direction - Vector3(1, 0, 0)), 0, 1e-15);
    const auto right = Camera(desc).refracted_ray(500, 240);
    ASSERT_TRUE(right);
    EXPECT_LT(right->direction.z, 0);
}

TEST(Camera, DistortionIsUndoneBeforeThePort) {
    CameraDesc desc = behind_port();
    desc.distortion.k[0] = -1.0 / 3;
    const Camera camera(desc);
    // x = 0.3 is shown at 0.3 (1 - 0.03) = 0.291; then Snell from air to water.
    const auto ray = camera.refracted_ray(320 + 500 * 0.291, 240);
    ASSERT_TRUE(ray);
    const double in_water = std::asin(std::sin(std::atan(0.3)) / 1.334);
    EXPECT_NEAR(ray->direction.x, std::sin(in_water), 1e-10);
    // The model shows nothing farther out than 2/3.
    EXPECT_FALSE(camera.refracted_ray(320 + 500 * 0.67, 240));
}

TEST(Camera, PortOfEqualIndicesIsAPinhole) {
    CameraDesc desc = behind_port();
    std::get<FlatPortDesc>(*desc.port).normal = glm::normalize(Vector3(0.2, 0.1, 1));
    std::get<FlatPortDesc>(*desc.port).n_air = std::get<FlatPortDesc>(*desc.port).n_glass =
        std::get<FlatPortDesc>(*desc.port).n_water = 1.334;
    const Camera with_port(desc), without(pinhole());
    for (double x = 0.5; x < 640; x += 71) {
        const auto a = with_port.refracted_ray(x, 100.5), b = without.refracted_ray(x, 100.5);
        ASSERT_TRUE(a && b);
        EXPECT_NEAR(glm::length(a->direction - b->direction), 0, 1e-15);
        EXPECT_NEAR(glm::length(glm::cross(a->origin - b->origin, b->direction)), 0, 1e-15);
    }
}

TEST(Camera, EnlargesByTheIndexOfWaterOnTheAxis) {
    // Paraxial optics: in the plane z = Z a ray of small slope t stands at
    // t (d + d_g n_a/n_g + (Z - d - d_g) n_a/n_w) from the axis, and at t Z without a housing.
    const Camera camera(behind_port());
    for (const double depth : {0.1, 0.5, 2.0, 10.0, 1e6}) {
        const double paraxial = depth / (0.02 + 0.04 / 1.49 + (depth - 0.06) / 1.334);
        // At 0.1 pixel the slope is 2e-4; what paraxial optics leaves out is of its square.
        EXPECT_NEAR(enlargement(camera, 320.1, depth), paraxial, 1e-7) << depth;
    }
    EXPECT_NEAR(enlargement(camera, 320.1, 1e6), 1.334, 1e-6);
    // An object centimetres from the glass is enlarged less: the housing has no single centre.
    EXPECT_NEAR(enlargement(camera, 320.1, 0.1), 1.3016, 1e-4);  // 0.1 / 0.07683 by hand
}

TEST(Camera, EnlargementGrowsOffTheAxis) {
    const Camera camera(behind_port());
    double last = enlargement(camera, 320.1, 2);
    for (double x = 340; x <= 640; x += 20) {
        const double here = enlargement(camera, x, 2);
        EXPECT_GT(here, last) << x;
        last = here;
    }
    // Far away the enlargement is tan(in air) / tan(in water): at slope 0.6 6.7 % above the axis.
    const double air = std::atan(0.6);
    const double far = 0.6 / std::tan(std::asin(std::sin(air) / 1.334));
    EXPECT_NEAR(enlargement(camera, 320 + 300, 1e6), far, 1e-6);
    EXPECT_GT(far, 1.06 * 1.334);
    EXPECT_NEAR(enlargement(camera, 320 - 300, 1e6), far, 1e-6);
}

}  // namespace
}  // namespace uw
