// ctest labels: unit analytic
#include "camera/port.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace uw {
namespace {

constexpr double k_degree = std::numbers::pi / 180;
constexpr double k_flat_tolerance = 1e-12;  // asked for by physics.md; rounding is 1e-16

/// The water ray by plane trigonometry: the plane of incidence holds the normal n and the in-plane
/// direction u, and every angle is measured from n.
struct ClosedForm {
    Point3 origin;
    Vector3 direction;
};
ClosedForm closed_form(const FlatPortDesc& port, const Vector3& n, const Vector3& u,
                       double angle_air) {
    const double angle_glass = std::asin(port.n_air / port.n_glass * std::sin(angle_air));
    const double angle_water = std::asin(port.n_air / port.n_water * std::sin(angle_air));
    const double across =
        port.distance * std::tan(angle_air) + port.thickness * std::tan(angle_glass);
    return {at_origin_plus((port.distance + port.thickness) * n + across * u),
            std::cos(angle_water) * n + std::sin(angle_water) * u};
}

void expect_near(const Vector3& a, const Vector3& b) {
    EXPECT_NEAR(a.x, b.x, k_flat_tolerance);
    EXPECT_NEAR(a.y, b.y, k_flat_tolerance);
    EXPECT_NEAR(a.z, b.z, k_flat_tolerance);
}

/// Compares at several azimuths about the port's normal.
void expect_closed_form(const FlatPortDesc& port, double angle_air) {
    const Vector3 n = port.normal;
    const Vector3 e1 = glm::normalize(glm::cross(n, Vector3(0.3, 1, 0.2)));
    const Vector3 e2 = glm::cross(n, e1);
    for (int i = 0; i < 7; ++i) {
        const Vector3 u = std::cos(0.9 * i) * e1 + std::sin(0.9 * i) * e2;
        const Vector3 in_air = std::cos(angle_air) * n + std::sin(angle_air) * u;
        const auto ray = make_port(port)->refracted_ray(in_air);
        ASSERT_TRUE(ray);
        const ClosedForm truth = closed_form(port, n, u, angle_air);
        expect_near(from_origin(ray->origin), from_origin(truth.origin));
        expect_near(ray->direction, truth.direction);
        EXPECT_NEAR(glm::length(ray->direction), 1, 1e-15);
    }
}

FlatPortDesc thick_port() {
    FlatPortDesc port;
    port.distance = 0.02;
    port.thickness = 0.04;
    return port;  // 1.0, 1.49, 1.334
}

TEST(FlatPort, ClosedFormAt0And10And40Degrees) {
    for (const double degrees : {0.0, 1e-9, 10.0, 40.0, 85.0}) {
        expect_closed_form(thick_port(), degrees * k_degree);
    }
}

TEST(FlatPort, ClosedFormThroughTiltedPort) {
    FlatPortDesc port = thick_port();
    port.normal = glm::normalize(Vector3(0.35, -0.2, 1));
    for (const double degrees : {0.0, 10.0, 40.0}) expect_closed_form(port, degrees * k_degree);
}

TEST(FlatPort, OpticalAxisThroughTiltedPort) {
    // Tilted by 25 degrees about y: the axis (0, 0, 1) meets the port off the foot of its normal.
    const double tilt = 25 * k_degree;
    FlatPortDesc port = thick_port();
    port.normal = {std::sin(tilt), 0, std::cos(tilt)};
    const auto ray = make_port(port)->refracted_ray({0, 0, 1});
    ASSERT_TRUE(ray);
    const double glass = std::asin(std::sin(tilt) / 1.49);
    const double water = std::asin(std::sin(tilt) / 1.334);
    // In the x-z plane a direction at angle a from the normal, on the axis' side, stands at
    // tilt - a from the axis.
    const double path_air = 0.02 / std::cos(tilt), path_glass = 0.04 / std::cos(glass);
    EXPECT_NEAR(ray->origin.x, path_glass * std::sin(tilt - glass), k_flat_tolerance);
    EXPECT_NEAR(ray->origin.y, 0, k_flat_tolerance);
    EXPECT_NEAR(ray->origin.z, path_air + path_glass * std::cos(tilt - glass), k_flat_tolerance);
    EXPECT_NEAR(ray->direction.x, std::sin(tilt - water), k_flat_tolerance);
    EXPECT_NEAR(ray->direction.z, std::cos(tilt - water), k_flat_tolerance);
}

TEST(FlatPort, EqualIndicesContinueThePinhole) {
    FlatPortDesc port = thick_port();
    port.n_air = port.n_glass = port.n_water = 1.334;
    port.normal = glm::normalize(Vector3(-0.1, 0.3, 1));
    for (const Vector3& v : {Vector3(0, 0, 1), Vector3(0.8, -0.5, 1), Vector3(-0.2, 1.1, 1)}) {
        const Vector3 direction = glm::normalize(v);
        const auto ray = make_port(port)->refracted_ray(direction);
        ASSERT_TRUE(ray);
        expect_near(ray->direction, direction);
        expect_near(glm::cross(from_origin(ray->origin), direction), Vector3(0.0));
        EXPECT_NEAR(glm::dot(from_origin(ray->origin), port.normal), 0.06, 1e-15);
    }
}

TEST(FlatPort, TotalReflectionBeyondTheCriticalAngle) {
    FlatPortDesc port = thick_port();
    port.n_air = 1.334;  // a camera in water looking into air
    port.n_water = 1.0;
    const double critical = std::asin(1 / 1.334);
    const auto towards = [](double angle) { return Vector3(std::sin(angle), 0, std::cos(angle)); };
    EXPECT_TRUE(make_port(port)->refracted_ray(towards(critical - 1e-6)));
    EXPECT_FALSE(make_port(port)->refracted_ray(towards(critical + 1e-6)));
    port.n_glass = 1.1;  // reflected by the inner surface already
    EXPECT_FALSE(make_port(port)->refracted_ray(towards(std::asin(1.1 / 1.334) + 1e-6)));
}

TEST(FlatPort, MissesBehindAndAlongTheGlass) {
    FlatPortDesc port = thick_port();
    EXPECT_FALSE(make_port(port)->refracted_ray({0, 0, -1}));
    EXPECT_FALSE(make_port(port)->refracted_ray({1, 0, 0}));
    port.normal = glm::normalize(Vector3(1, 0, 0.1));
    EXPECT_FALSE(make_port(port)->refracted_ray(glm::normalize(Vector3(-1, 0, 1))));
}

}  // namespace
}  // namespace uw
