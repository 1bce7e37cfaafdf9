// ctest labels: unit analytic
#include "camera/port.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/fresnel_by_angles.h"

namespace uw {
namespace {

constexpr double k_tolerance = 1e-12;  // asked for by physics.md; rounding is 1e-16

DomePortDesc dome(const Point3& center) {
    DomePortDesc port;
    port.center = center;
    port.radius = 0.05;
    port.thickness = 0.007;
    return port;  // 1.0, 1.49, 1.334
}

const Vector3 k_directions[] = {{0, 0, 1}, {0.3, -0.2, 1}, {-1, 0.4, 0.2}, {0.1, 1, -0.7}};

TEST(DomePort, CentredBendsNothing) {
    for (const Vector3& v : k_directions) {
        const Vector3 d = glm::normalize(v);
        const auto ray = make_port(dome({0, 0, 0}))->refracted_ray(d);
        ASSERT_TRUE(ray);
        EXPECT_LT(glm::length(ray->direction - d), k_tolerance);
        EXPECT_LT(glm::length(from_origin(ray->origin) - 0.057 * d), k_tolerance);
    }
}

// Bouguer's law: n (x - C) x d, the "angular momentum" of a ray about the spheres' centre, is the
// same vector in air, glass and water. It holds the plane of the ray and Snell's law at both
// surfaces; with the origin on the outer sphere it fixes the ray in water.
TEST(DomePort, KeepsTheInvariantOfBouguer) {
    const Point3 center{0.012, -0.02, -0.03};
    for (const Vector3& v : k_directions) {
        const Vector3 d = glm::normalize(v);
        const auto ray = make_port(dome(center))->refracted_ray(d);
        ASSERT_TRUE(ray);
        const Vector3 outer = ray->origin - center;
        EXPECT_NEAR(glm::length(outer), 0.057, k_tolerance);
        EXPECT_NEAR(glm::length(ray->direction), 1, 1e-15);
        EXPECT_GT(glm::dot(ray->direction, outer), 0);
        const Vector3 in_air = glm::cross(-from_origin(center), d);
        EXPECT_LT(glm::length(1.334 * glm::cross(outer, ray->direction) - in_air), k_tolerance);
    }
}

// Rays along the line through the centre and the camera meet both surfaces at right angles.
TEST(DomePort, PointsOnTheLineThroughItsCentreAreSeenStraightOn) {
    for (const Vector3& offset : {Vector3{0, 0, 0.02}, Vector3{0.01, -0.02, 0.03}}) {
        const auto port = make_port(dome(at_origin_plus(offset)));
        const Vector3 away = glm::normalize(offset);
        for (const double distance : {0.2, 3.0})
            for (const double side : {1.0, -1.0}) {
                const auto seen =
                    port->direction_to(at_origin_plus(offset + side * distance * away));
                ASSERT_TRUE(seen);
                // 1e-7: a point is off the line by its own rounding, and that by the square root.
                EXPECT_LT(glm::length(*seen - side * away), 1e-7) << distance;
            }
    }
}

TEST(DomePort, OffAxisRayByPlaneTrigonometry) {
    // The camera 2 cm before the centre looks sideways: at right angles to the offset, so that the
    // angle in air at the inner sphere is asin(0.02 / 0.05) and everything stays in one plane.
    const double air = std::asin(0.02 / 0.05);
    const double glass_in = std::asin(std::sin(air) / 1.49);
    const double glass_out = std::asin(0.05 / 0.057 * std::sin(glass_in));
    const double water = std::asin(1.49 / 1.334 * std::sin(glass_out));
    // Polar angle about the centre, from the offset's direction z towards x.
    const double leaves = (std::numbers::pi / 2 - air) + (glass_in - glass_out);
    const auto ray = make_port(dome({0, 0, -0.02}))->refracted_ray({1, 0, 0});
    ASSERT_TRUE(ray);
    EXPECT_NEAR(ray->origin.x, 0.057 * std::sin(leaves), k_tolerance);
    EXPECT_NEAR(ray->origin.z, 0.057 * std::cos(leaves) - 0.02, k_tolerance);
    EXPECT_NEAR(ray->direction.x, std::sin(leaves + water), k_tolerance);
    EXPECT_NEAR(ray->direction.z, std::cos(leaves + water), k_tolerance);
    EXPECT_NEAR(ray->direction.y, 0, k_tolerance);
}

TEST(DomePort, AHugeDomeIsAFlatPort) {
    DomePortDesc huge;
    huge.radius = 1e5;
    huge.center = {0, 0, 0.02 - 1e5};
    huge.thickness = 0.04;
    FlatPortDesc flat;
    flat.distance = 0.02;
    flat.thickness = 0.04;
    for (const Vector3& v : {Vector3(0, 0, 1), Vector3(0.5, 0.2, 1), Vector3(-1, 0.3, 1)}) {
        const Vector3 d = glm::normalize(v);
        const auto a = make_port(huge)->refracted_ray(d), b = make_port(flat)->refracted_ray(d);
        ASSERT_TRUE(a && b);
        // The normals differ by 0.06 m / 1e5 m; radii of 1e5 leave 1e-11 m of a double.
        EXPECT_LT(glm::length(a->direction - b->direction), 2e-6);
        EXPECT_LT(glm::length(a->origin - b->origin), 2e-6);
    }
}

TEST(DomePort, EqualIndicesContinueThePinhole) {
    DomePortDesc port = dome({0.01, 0.02, -0.03});
    port.n_air = port.n_glass = port.n_water = 1.334;
    for (const Vector3& v : k_directions) {
        const Vector3 d = glm::normalize(v);
        const auto ray = make_port(port)->refracted_ray(d);
        ASSERT_TRUE(ray);
        EXPECT_LT(glm::length(ray->direction - d), k_tolerance);
        EXPECT_LT(glm::length(glm::cross(from_origin(ray->origin), d)), k_tolerance);
        const auto back = make_port(port)->direction_to(ray->at(1));
        ASSERT_TRUE(back);
        EXPECT_LT(glm::length(*back - d), k_tolerance);
    }
}

TEST(DomePort, ThinGlassAndNoGlass) {
    DomePortDesc port = dome({0, 0, -0.02});
    port.thickness = 0;
    const auto none = make_port(port)->refracted_ray(glm::normalize(Vector3(0.4, 0, 1)));
    port.thickness = 1e-9;
    const auto thin = make_port(port)->refracted_ray(glm::normalize(Vector3(0.4, 0, 1)));
    ASSERT_TRUE(none && thin);
    EXPECT_LT(glm::length(none->direction - thin->direction), 1e-7);
    EXPECT_NEAR(distance(none->origin, port.center), 0.05, k_tolerance);
}

TEST(DomePort, TotalReflectionWhereAirIsDenser) {
    DomePortDesc port = dome({0, 0, -0.049});
    port.n_air = 1.334;
    port.n_water = 1.0;
    // At right angles to the offset the angle at the inner sphere is asin(0.98): too flat.
    EXPECT_FALSE(make_port(port)->refracted_ray({1, 0, 0}));
    port.fresnel = true;
    EXPECT_EQ(make_port(port)->transmittance({1, 0, 0}), 0);
    EXPECT_TRUE(make_port(port)->refracted_ray({0, 0, 1}));
}

// A direction found leads to its point, and none is found for a point that no light reaches: behind
// a camera close to the glass most is reflected totally.
TEST(DomePort, DirectionsFoundLeadToTheirPoints) {
    DomePortDesc desc = dome({0, 0, -0.045});
    desc.n_air = desc.n_glass = 1.5;
    desc.n_water = 1;
    const auto port = make_port(desc);
    int found = 0, none = 0;
    for (int i = 0; i < 60; ++i) {
        const double angle = std::numbers::pi * (i + 0.5) / 60;
        const Point3 point = desc.center + 0.3 * Vector3(std::sin(angle), 0, std::cos(angle));
        const auto seen = port->direction_to(point);
        if (!seen) {
            ++none;
            continue;
        }
        ++found;
        const auto ray = port->refracted_ray(*seen);
        ASSERT_TRUE(ray) << i;
        const Vector3 to_point = point - ray->origin;
        EXPECT_LT(glm::length(glm::cross(to_point, ray->direction)), 1e-9) << i;
        EXPECT_GT(glm::dot(to_point, ray->direction), 0) << i;
    }
    EXPECT_GT(found, 0);
    EXPECT_GT(none, 0);
}

TEST(DomePort, FresnelOfACentredDomeIsThatOfNormalIncidence) {
    DomePortDesc port = dome({0, 0, 0});
    port.fresnel = true;
    const double inner = std::pow(0.49 / 2.49, 2), outer = std::pow(0.156 / 2.824, 2);
    for (const Vector3& v : k_directions)
        EXPECT_NEAR(make_port(port)->transmittance(glm::normalize(v)), (1 - inner) * (1 - outer),
                    1e-12);
    port.radiance_in_air = true;
    EXPECT_NEAR(make_port(port)->transmittance({0, 0, 1}),
                (1 - inner) * (1 - outer) / (1.334 * 1.334), 1e-12);
}

TEST(DomePort, FresnelOffCentreByAngles) {
    DomePortDesc port = dome({0, 0, -0.02});
    port.fresnel = true;
    const double sine = 0.02 / 0.05;  // as in OffAxisRayByPlaneTrigonometry
    const test::Polarised a = test::fresnel_by_angles(std::asin(sine), 1.0, 1.49);
    const test::Polarised b =
        test::fresnel_by_angles(std::asin(0.05 / 0.057 * sine / 1.49), 1.49, 1.334);
    EXPECT_NEAR(make_port(port)->transmittance({1, 0, 0}), 0.5 * (a.s * b.s + a.p * b.p), 1e-12);
}

}  // namespace
}  // namespace uw
