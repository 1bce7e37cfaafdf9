// ctest labels: unit analytic
#include "camera/port.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "camera/camera.h"

namespace uw {
namespace {

constexpr double k_radians_per_degree = std::numbers::pi / 180;
constexpr double k_rounding = 1e-14;  // a dozen operations on numbers near 1

// Another form of Fresnel's equations, by angles: R_s = sin^2(i - t) / sin^2(i + t) and
// R_p = tan^2(i - t) / tan^2(i + t).
FresnelTransmittance by_angles(double incidence, double n1, double n2) {
    const double refracted = std::asin(n1 / n2 * std::sin(incidence));
    const double s = std::sin(incidence - refracted) / std::sin(incidence + refracted);
    const double p = std::tan(incidence - refracted) / std::tan(incidence + refracted);
    return {1 - s * s, 1 - p * p};
}

TEST(Fresnel, NormalIncidence) {
    const FresnelTransmittance t = fresnel_transmittance(1, 1.0, 1.5);
    EXPECT_NEAR(t.s, 1 - 0.04, k_rounding);  // (0.5 / 2.5)^2
    EXPECT_NEAR(t.p, 1 - 0.04, k_rounding);
}

TEST(Fresnel, EqualsTheFormInAngles) {
    for (const double degrees : {1.0, 20.0, 45.0, 70.0, 89.0}) {
        const double cosine = std::cos(degrees * k_radians_per_degree);
        const FresnelTransmittance found = fresnel_transmittance(cosine, 1.0, 1.49);
        const FresnelTransmittance truth = by_angles(degrees * k_radians_per_degree, 1.0, 1.49);
        // sin(i - t) of 1 degree loses two digits.
        EXPECT_NEAR(found.s, truth.s, 1e-12) << degrees;
        EXPECT_NEAR(found.p, truth.p, 1e-12) << degrees;
    }
}

TEST(Fresnel, BrewstersAngleReflectsNothingInPlane) {
    const double brewster = std::atan(1.49 / 1.0);
    const FresnelTransmittance t = fresnel_transmittance(std::cos(brewster), 1.0, 1.49);
    EXPECT_NEAR(t.p, 1, k_rounding);
    // Reflected and refracted ray are at right angles there: R_s = cos^2(2 i).
    EXPECT_NEAR(t.s, 1 - std::pow(std::cos(2 * brewster), 2), k_rounding);
}

TEST(Fresnel, TotalReflectionLetsNothingThrough) {
    const double critical = std::asin(1 / 1.49);
    const auto beyond = fresnel_transmittance(std::cos(critical + 1e-9), 1.49, 1.0);
    EXPECT_EQ(beyond.s, 0);
    EXPECT_EQ(beyond.p, 0);
    EXPECT_GT(fresnel_transmittance(std::cos(critical - 1e-9), 1.49, 1.0).s, 0);
    EXPECT_EQ(fresnel_transmittance(0, 1.0, 1.49).s, 0);  // grazing
}

TEST(Fresnel, EqualIndicesAreNoSurface) {
    for (const double cosine : {1.0, 0.7, 0.01}) {
        // cos2 from cos1 by a difference: rounding over cos1^2.
        EXPECT_NEAR(fresnel_transmittance(cosine, 1.334, 1.334).s, 1, 1e-11);
        EXPECT_NEAR(fresnel_transmittance(cosine, 1.334, 1.334).p, 1, 1e-11);
    }
}

TEST(Fresnel, TheWayBackIsTheSame) {
    const double incidence = 50 * k_radians_per_degree;
    const double refracted = std::asin(std::sin(incidence) / 1.49);
    const auto in = fresnel_transmittance(std::cos(incidence), 1.0, 1.49);
    const auto out = fresnel_transmittance(std::cos(refracted), 1.49, 1.0);
    EXPECT_NEAR(in.s, out.s, k_rounding);
    EXPECT_NEAR(in.p, out.p, k_rounding);
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
    EXPECT_NEAR(FlatPort(glass()).transmittance({0, 0, 1}), (1 - inner) * (1 - outer), k_rounding);
}

TEST(PortTransmittance, PolarisationOfTheFirstSurfaceMeetsTheSecond) {
    FlatPortDesc port = glass();
    port.normal = glm::normalize(Vector3(0.3, 0.1, 1));
    const Vector3 direction = glm::normalize(Vector3(-0.6, 0.4, 1));
    const double air = std::acos(glm::dot(direction, port.normal));
    const FresnelTransmittance inner = by_angles(air, 1.0, 1.49);
    const FresnelTransmittance outer = by_angles(std::asin(std::sin(air) / 1.49), 1.49, 1.334);
    EXPECT_NEAR(FlatPort(port).transmittance(direction),
                0.5 * (inner.s * outer.s + inner.p * outer.p), 1e-12);
    // Not the product of two unpolarised surfaces.
    EXPECT_GT(FlatPort(port).transmittance(direction),
              0.25 * (inner.s + inner.p) * (outer.s + outer.p) + 1e-6);
}

TEST(PortTransmittance, OffIsExactlyOne) {
    FlatPortDesc port = glass();
    port.fresnel = false;
    EXPECT_EQ(FlatPort(port).transmittance(glm::normalize(Vector3(0.5, 0.5, 1))), 1);
}

TEST(PortTransmittance, RadianceInAirIsSmallerByTheSquareOfTheIndex) {
    FlatPortDesc port = glass();
    const double in_water = FlatPort(port).transmittance({0, 0, 1});
    port.radiance_in_air = true;
    EXPECT_NEAR(FlatPort(port).transmittance({0, 0, 1}), in_water / (1.334 * 1.334), k_rounding);
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
                FlatPort(glass()).transmittance(glm::normalize(Vector3(1, 0, 1))), k_rounding);
}

}  // namespace
}  // namespace uw
