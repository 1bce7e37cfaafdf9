// ctest labels: unit analytic
#include "camera/port.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "camera/camera.h"
#include "tests/support/fresnel_by_angles.h"

namespace uw {
namespace {

constexpr double k_rounding = 1e-14;  // a dozen operations on numbers near 1

/// The transmittance of one surface between two media for unpolarised light that meets it at an
/// angle to its normal [rad]: that of a port whose glass is as dense as what lies behind it.
double fresnel_transmittance(double incidence, double n1, double n2) {
    FlatPortDesc port;
    port.n_air = n1;
    port.n_glass = port.n_water = n2;
    port.fresnel = true;
    return make_port(port)->transmittance({std::sin(incidence), 0, std::cos(incidence)});
}

TEST(Fresnel, NormalIncidence) {
    EXPECT_NEAR(fresnel_transmittance(0, 1.0, 1.5), 1 - 0.04, k_rounding);  // (0.5 / 2.5)^2
}

TEST(Fresnel, EqualsTheFormInAngles) {
    for (const double degrees : {1.0, 20.0, 45.0, 70.0, 89.0}) {
        // sin(i - t) of 1 degree loses two digits.
        EXPECT_NEAR(fresnel_transmittance(degrees * k_degree, 1.0, 1.49),
                    test::fresnel_by_angles(degrees * k_degree, 1.0, 1.49).mean(), 1e-12)
            << degrees;
    }
}

/// The transmittance of one surface for each polarisation. That of a port with as much air behind
/// the glass as before it is the mean of their squares, since the way out is the same as the way
/// in.
test::Polarised fresnel_by_polarisation(double incidence, double n1, double n2) {
    FlatPortDesc port;
    port.n_air = port.n_water = n1;
    port.n_glass = n2;
    port.fresnel = true;
    const double mean = fresnel_transmittance(incidence, n1, n2);
    const double mean_square =
        make_port(port)->transmittance({std::sin(incidence), 0, std::cos(incidence)});
    const double half_apart = std::sqrt(std::max(mean_square - mean * mean, 0.0));
    return {mean - half_apart, mean + half_apart};
}

TEST(Fresnel, EqualsTheFormInAnglesForEachPolarisation) {
    for (const double degrees : {20.0, 45.0, 70.0, 89.0}) {
        const test::Polarised found = fresnel_by_polarisation(degrees * k_degree, 1.0, 1.49);
        const test::Polarised truth = test::fresnel_by_angles(degrees * k_degree, 1.0, 1.49);
        // Rounding of the squares, over how far they are apart: 0.02 at 20 degrees.
        EXPECT_NEAR(found.s, truth.s, 1e-12) << degrees;
        EXPECT_NEAR(found.p, truth.p, 1e-12) << degrees;
    }
    const double brewster = std::atan(1.49);
    EXPECT_NEAR(fresnel_by_polarisation(brewster, 1.0, 1.49).p, 1, k_rounding);
}

TEST(Fresnel, BrewstersAngleReflectsNothingInPlane) {
    const double brewster = std::atan(1.49 / 1.0);
    // Reflected and refracted ray are at right angles there: R_s = cos^2(2 i), and R_p = 0.
    EXPECT_NEAR(fresnel_transmittance(brewster, 1.0, 1.49),
                1 - 0.5 * std::pow(std::cos(2 * brewster), 2), k_rounding);
}

TEST(Fresnel, TotalReflectionLetsNothingThrough) {
    const double critical = std::asin(1 / 1.49);
    EXPECT_EQ(fresnel_transmittance(critical + 1e-9, 1.49, 1.0), 0);
    EXPECT_GT(fresnel_transmittance(critical - 1e-9, 1.49, 1.0), 0);
    FlatPortDesc port;
    port.fresnel = true;
    EXPECT_EQ(make_port(port)->transmittance({1, 0, 0}), 0);  // grazing
}

TEST(Fresnel, EqualIndicesAreNoSurface) {
    for (const double cosine : {1.0, 0.7, 0.01}) {
        // cos2 from cos1 by a difference: rounding over cos1^2.
        EXPECT_NEAR(fresnel_transmittance(std::acos(cosine), 1.334, 1.334), 1, 1e-11);
    }
}

TEST(Fresnel, TheWayBackIsTheSame) {
    const double incidence = 50 * k_degree;
    const double refracted = std::asin(std::sin(incidence) / 1.49);
    EXPECT_NEAR(fresnel_transmittance(incidence, 1.0, 1.49),
                fresnel_transmittance(refracted, 1.49, 1.0), k_rounding);
}

FlatPortDesc glass() {
    FlatPortDesc port;
    port.distance = 0.02;
    port.thickness = 0.04;
    port.fresnel = true;
    return port;
}

TEST(PortTransmittance, BothSurfacesAtNormalIncidence) {
    const double inner = std::pow((1.49 - 1) / (1.49 + 1), 2);          // 3.87 %
    const double outer = std::pow((1.49 - 1.334) / (1.49 + 1.334), 2);  // 0.31 %
    EXPECT_NEAR(make_port(glass())->transmittance({0, 0, 1}), (1 - inner) * (1 - outer),
                k_rounding);
}

TEST(PortTransmittance, PolarisationOfTheFirstSurfaceMeetsTheSecond) {
    FlatPortDesc port = glass();
    port.normal = glm::normalize(Vector3(0.3, 0.1, 1));
    const Vector3 direction = glm::normalize(Vector3(-0.6, 0.4, 1));
    const double air = std::acos(glm::dot(direction, port.normal));
    const test::Polarised inner = test::fresnel_by_angles(air, 1.0, 1.49);
    const test::Polarised outer =
        test::fresnel_by_angles(std::asin(std::sin(air) / 1.49), 1.49, 1.334);
    EXPECT_NEAR(make_port(port)->transmittance(direction),
                0.5 * (inner.s * outer.s + inner.p * outer.p), 1e-12);
    // Not the product of two unpolarised surfaces.
    EXPECT_GT(make_port(port)->transmittance(direction),
              0.25 * (inner.s + inner.p) * (outer.s + outer.p) + 1e-6);
}

TEST(PortTransmittance, OffIsExactlyOne) {
    FlatPortDesc port = glass();
    port.fresnel = false;
    EXPECT_EQ(make_port(port)->transmittance(glm::normalize(Vector3(0.5, 0.5, 1))), 1);
}

TEST(PortTransmittance, RadianceInAirIsSmallerByTheSquareOfTheIndex) {
    FlatPortDesc port = glass();
    const double in_water = make_port(port)->transmittance({0, 0, 1});
    port.radiance_in_air = true;
    EXPECT_NEAR(make_port(port)->transmittance({0, 0, 1}), in_water / (1.334 * 1.334), k_rounding);
}

TEST(LensRay, AngleInsideTheHousingAndTransmittance) {
    CameraDesc desc;
    desc.width = 640;
    desc.height = 480;
    desc.intrinsics = {500, 500, 320, 240};
    desc.world_from_camera = Affine{};
    EXPECT_EQ(Camera(desc).lens_ray(320, 240).falloff, 1);
    EXPECT_NEAR(Camera(desc).lens_ray(820, 240).falloff, 0.25, k_rounding);
    EXPECT_EQ(Camera(desc).lens_ray(820, 240).port_transmittance, 1);
    desc.port = glass();  // bends the ray in water, not in the housing
    const LensRay behind_glass = Camera(desc).lens_ray(820, 240);
    EXPECT_NEAR(behind_glass.falloff, 0.25, k_rounding);
    EXPECT_NEAR(behind_glass.port_transmittance,
                make_port(glass())->transmittance(glm::normalize(Vector3(1, 0, 1))), k_rounding);
}

}  // namespace
}  // namespace uw
