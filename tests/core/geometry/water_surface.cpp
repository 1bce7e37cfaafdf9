// ctest labels: unit analytic
// The water's surface by itself: Snell and Fresnel against forms by angles, and mirror images.
#include "core/geometry/water_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/fresnel_by_angles.h"

namespace uw::test {
namespace {

const WaterSurface k_sloping(WaterSurfaceDesc{
    {1, 2, 3}, glm::normalize(Vector3(0.2, 1, -0.1)), 1.34});

TEST(WaterSurface, ReflectsAsFresnelSays) {
    EXPECT_NEAR(k_sloping.reflectance_from_water(1), std::pow(0.34 / 2.34, 2), 1e-15);
    EXPECT_NEAR(k_sloping.reflectance_from_air(1), std::pow(0.34 / 2.34, 2), 1e-15);
    const double critical = std::asin(1 / 1.34);
    EXPECT_NEAR(k_sloping.critical_cosine(), std::cos(critical), 1e-15);
    for (double angle = 0.05; angle < std::numbers::pi / 2; angle += 0.05) {
        const double cosine = std::cos(angle);
        EXPECT_NEAR(k_sloping.reflectance_from_air(cosine),
                    1 - fresnel_by_angles(angle, 1, 1.34).mean(), 1e-13);
        const double from_water =
            angle < critical ? 1 - fresnel_by_angles(angle, 1.34, 1).mean() : 1;
        EXPECT_NEAR(k_sloping.reflectance_from_water(cosine), from_water, 1e-13);
    }
}

TEST(WaterSurface, RefractsThereAndBack) {
    const Vector3 up = k_sloping.up();
    for (const Vector3& v : {Vector3(0.3, 0.9, 0.1), Vector3(-0.1, 1, 0.4), Vector3(0, 1, 0)}) {
        const Vector3 in_water = glm::normalize(v);
        const Vector3 in_air = k_sloping.into_air(in_water, up).value();
        // Snell's law: the parts along the surface are as 1.34 to 1.
        EXPECT_LT(glm::length(in_air - glm::dot(in_air, up) * up -
                              1.34 * (in_water - glm::dot(in_water, up) * up)),
                  1e-14);
        EXPECT_NEAR(glm::length(in_air), 1, 1e-14);
        EXPECT_GT(glm::dot(in_air, up), 0);
        EXPECT_LT(glm::length(k_sloping.into_water(-in_air) + in_water), 1e-14);
    }
    EXPECT_FALSE(
        k_sloping.into_air(glm::normalize(Vector3(1, 0.5, 0)), k_sloping.up()).has_value());
}

TEST(WaterSurface, HasAMirrorImage) {
    const Point3 x{0.3, -4, 2}, y{-3, -1, 5};
    const Point3 image = k_sloping.mirrored(x);
    EXPECT_NEAR(k_sloping.height(image), -k_sloping.height(x), 1e-14);
    EXPECT_LT(glm::length(glm::cross(image - x, k_sloping.up())), 1e-14);
    // By the law of reflection the way by the surface is straight from the image.
    const Point3 at = k_sloping.between(image, y);
    EXPECT_NEAR(k_sloping.height(at), 0, 1e-14);
    EXPECT_NEAR(distance(x, at) + distance(at, y), distance(image, y), 1e-13);
    const Ray ray{x, glm::normalize(at - x)};
    EXPECT_NEAR(k_sloping.crossing(ray).value(), distance(x, at), 1e-13);
    EXPECT_LT(glm::length(k_sloping.mirrored(ray.direction) - glm::normalize(y - at)), 1e-13);
    EXPECT_FALSE(k_sloping.crossing({x, -ray.direction}).has_value());
}

}  // namespace
}  // namespace uw::test
