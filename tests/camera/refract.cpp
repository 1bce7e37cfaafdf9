// ctest labels: unit analytic
#include "camera/port.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace uw {
namespace {

constexpr double k_snell_rounding = 1e-14;

void expect_same_direction(const Vector3& a, const Vector3& b) {
    EXPECT_LT(glm::length(a - b), k_snell_rounding);
}

/// The direction of a ray behind one surface, from index `n1` to `n2`: that of a port whose glass
/// is as dense as what lies behind it.
std::optional<Vector3> refract(const Vector3& direction, const Vector3& normal, double n1,
                               double n2) {
    FlatPortDesc port;
    port.normal = normal;
    port.n_air = n1;
    port.n_glass = port.n_water = n2;
    const std::optional<Ray> ray = make_port(port)->refracted_ray(direction);
    return ray ? std::optional(ray->direction) : std::nullopt;
}

TEST(Refract, KeepsTheInvariantOfSnell) {
    // n1 (d x n) = n2 (t x n): the law itself, for directions of no particular plane.
    const Vector3 n = glm::normalize(Vector3(0.2, -0.4, 1));
    const Vector3 d = glm::normalize(Vector3(-0.5, 0.3, 0.9));
    const auto t = refract(d, n, 1.0, 1.49);
    ASSERT_TRUE(t);
    expect_same_direction(glm::cross(d, n), 1.49 * glm::cross(*t, n));
    EXPECT_GT(glm::dot(*t, n), glm::dot(d, n));
    EXPECT_NEAR(glm::length(*t), 1, k_snell_rounding);
}

TEST(Refract, BendsByTheSineOfTheAngle) {
    // From air at 30 degrees into an index of 1.5: sin t = 1/3.
    const double angle = std::numbers::pi / 6;
    const auto t = refract({std::sin(angle), 0, std::cos(angle)}, {0, 0, 1}, 1, 1.5);
    expect_same_direction(t.value(), {1.0 / 3, 0, std::sqrt(8.0) / 3});
}

TEST(Refract, AlongTheNormalAndBetweenEqualIndicesNothingBends) {
    EXPECT_EQ(refract({0, 0, 1}, {0, 0, 1}, 1, 1.334).value(), Vector3(0, 0, 1));
    const Vector3 d = glm::normalize(Vector3(0.7, 0.1, 0.2));
    expect_same_direction(refract(d, {0, 0, 1}, 1.334, 1.334).value(), d);
}

TEST(Refract, TheWayBackIsTheSame) {
    const Vector3 n = glm::normalize(Vector3(0.1, 0.2, 1));
    const Vector3 d = glm::normalize(Vector3(0.6, -0.2, 1));
    const Vector3 t = refract(d, n, 1.0, 1.49).value();
    expect_same_direction(refract(-t, -n, 1.49, 1.0).value(), -d);
}

TEST(Refract, ReflectsTotallyBeyondTheCriticalAngle) {
    const double critical = std::asin(1 / 1.5);
    const auto from_glass = [](double angle) {
        return refract({std::sin(angle), 0, std::cos(angle)}, {0, 0, 1}, 1.5, 1);
    };
    EXPECT_TRUE(from_glass(critical - 1e-6));
    EXPECT_FALSE(from_glass(critical + 1e-6));
}

TEST(Refract, TransmittanceOfAPortIsThatOfItsTwoSurfaces) {
    FlatPortDesc flat;
    flat.n_air = 1;
    flat.n_glass = 1.5;
    flat.n_water = 1.2;
    const Vector3 ahead(0, 0, 1), aside = glm::normalize(Vector3(1, 0, 1));
    EXPECT_EQ(make_port(flat)->transmittance(ahead), 1);  // nothing was asked for
    flat.fresnel = true;
    const double inner = 0.5 / 2.5, outer = 0.3 / 2.7;  // along the normal
    const double expected = (1 - inner * inner) * (1 - outer * outer);
    EXPECT_NEAR(make_port(flat)->transmittance(ahead), expected, k_snell_rounding);
    flat.radiance_in_air = true;
    EXPECT_NEAR(make_port(flat)->transmittance(ahead), expected / 1.44, k_snell_rounding);
    flat.fresnel = false;
    EXPECT_NEAR(make_port(flat)->transmittance(aside), 1 / 1.44, k_snell_rounding);

    DomePortDesc dome;
    dome.radius = 0.05;
    dome.n_air = 1;
    dome.n_glass = 1.5;
    dome.n_water = 1.2;
    dome.fresnel = true;
    EXPECT_NEAR(make_port(dome)->transmittance(ahead), expected, k_snell_rounding);
}

}  // namespace
}  // namespace uw
