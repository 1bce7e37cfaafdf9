// ctest labels: unit analytic
#include "camera/lens_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "camera/camera.h"

namespace uw {
namespace {

using std::numbers::pi;
constexpr double k_fisheye_tolerance = 1e-10;  // what docs/physics.md promises

DistortionDesc fisheye(double k1 = 0, double k2 = 0, double k3 = 0, double k4 = 0) {
    return {{k1, k2, k3, k4, 0, 0}, {}, DistortionDesc::Model::fisheye};
}

Vector3 at_angle(double theta, double azimuth) {
    return {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth),
            std::cos(theta)};
}

TEST(Fisheye, FollowsTheFormulaOfOpenCv) {
    // cv::fisheye::projectPoints with K = I, D = (0.1, -0.02, 0.003, -0.0004) for (0.6, -0.8, 1),
    // written out: r = 1, theta = pi/4, theta_d = theta (1 + k1 t^2 + k2 t^4 + k3 t^6 + k4 t^8).
    const double t = pi / 4;
    const double shown = t * (1 + 0.1 * std::pow(t, 2) - 0.02 * std::pow(t, 4) +
                              0.003 * std::pow(t, 6) - 0.0004 * std::pow(t, 8));
    const auto image =
        Fisheye(fisheye(0.1, -0.02, 0.003, -0.0004)).image(glm::normalize(Vector3(0.6, -0.8, 1)));
    ASSERT_TRUE(image);
    EXPECT_NEAR(image->x, 0.6 * shown, 1e-15);
    EXPECT_NEAR(image->y, -0.8 * shown, 1e-15);
}

TEST(Fisheye, RoundTripBeyondTheHemisphere) {
    for (const DistortionDesc& desc : {fisheye(), fisheye(0.05, -0.01, 0.002, -0.0001)}) {
        const Fisheye lens(desc);
        for (double theta = 0; theta < lens.max_angle() - 1e-6; theta += 0.05) {
            const Vector3 direction = at_angle(theta, 2 * theta);
            const auto image = lens.image(direction);
            ASSERT_TRUE(image) << theta;
            const auto back = lens.direction(*image);
            ASSERT_TRUE(back) << theta;
            EXPECT_LT(glm::length(*back - direction), k_fisheye_tolerance) << theta;
            EXPECT_NEAR(glm::length(*back), 1, 1e-14);
        }
    }
}

TEST(Fisheye, EndsAtItsFold) {
    // theta - theta^3 / 3 grows up to theta = 1, where it is 2/3.
    const Fisheye lens(fisheye(-1.0 / 3));
    EXPECT_NEAR(lens.max_angle(), 1, 1e-12);
    EXPECT_TRUE(lens.direction({0.666, 0}));
    EXPECT_FALSE(lens.direction({0.667, 0}));
    EXPECT_TRUE(lens.image(at_angle(0.999, 1)));
    EXPECT_FALSE(lens.image(at_angle(1.001, 1)));
    EXPECT_EQ(Fisheye(fisheye()).max_angle(), pi);
    EXPECT_FALSE(Fisheye(fisheye()).image({0, 0, -1}));
}

TEST(Fisheye, ImageOfTheWholeSphereIsADisc) {
    CameraDesc desc;
    desc.width = desc.height = 400;
    desc.intrinsics = {190 / pi, 190 / pi, 200, 200};
    desc.distortion = fisheye();
    const Camera camera(desc);
    for (int j = 0; j < 400; j += 7) {
        for (int i = 0; i < 400; i += 7) {
            const double r = std::hypot(i + 0.5 - 200, j + 0.5 - 200);
            EXPECT_EQ(camera.refracted_ray(i + 0.5, j + 0.5).has_value(), r < 190) << i << " " << j;
        }
    }
    const auto sideways = camera.refracted_ray(200 + 95, 200);  // 90 degrees
    ASSERT_TRUE(sideways);
    EXPECT_NEAR(sideways->direction.x, 1, 1e-14);
    EXPECT_NEAR(sideways->direction.z, 0, 1e-14);
    EXPECT_LT(camera.refracted_ray(200, 200 - 150)->direction.z, -0.7);
}

TEST(Fisheye, FalloffKeepsTheEnergy) {
    // The lens gathers the same from every direction of the sphere: irradiance integrated over the
    // disc of the image is the solid angle that it shows.
    for (const DistortionDesc& desc : {fisheye(), fisheye(0.05, -0.01, 0.002, -0.0001)}) {
        const Fisheye lens(desc);
        constexpr int k_steps = 20000;
        const double edge = 1.5;
        double sum = 0, last_angle = 0;
        for (int i = 0; i < k_steps; ++i) {
            const double r = edge * (i + 0.5) / k_steps;
            const auto direction = lens.direction({r, 0});
            ASSERT_TRUE(direction);
            sum += lens.falloff(*direction) * 2 * pi * r * edge / k_steps;
            last_angle = std::acos(lens.direction({edge, 0})->z);
        }
        EXPECT_NEAR(sum, 2 * pi * (1 - std::cos(last_angle)), 1e-6);  // midpoint rule
    }
}

TEST(Fisheye, BehindAFlatPortSeesThroughItsHalfOnly) {
    CameraDesc desc;
    desc.width = desc.height = 400;
    desc.intrinsics = {100, 100, 200, 200};
    desc.distortion = fisheye();
    desc.port = FlatPortDesc{{0, 0, 1}, 0.02, 0.01, 1.0, 1.49, 1.334};
    const Camera camera(desc);
    const auto grazing = camera.refracted_ray(200 + 100 * 1.57, 200);  // pi/2 is 1.5708
    ASSERT_TRUE(grazing);
    EXPECT_NEAR(grazing->direction.x, 1 / 1.334, 1e-6);
    EXPECT_FALSE(camera.refracted_ray(200 + 100 * 1.572, 200));
}

}  // namespace
}  // namespace uw
