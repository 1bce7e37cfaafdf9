// ctest labels: unit analytic
#include "core/light/lamp_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/support/lamp_profile_laws.h"

namespace uw::test {
namespace {

using std::numbers::pi;
using Falloff = SpotProfileDesc::Falloff;

constexpr Falloff k_falloffs[] = {Falloff::smooth, Falloff::gltf, Falloff::blender,
                                  Falloff::blender_3_4};

constexpr double radians_of(double degrees) {
    return degrees * pi / 180;
}

/// Along z; with its intensity `degrees` from there.
struct Spot {
    SpotProfile profile;

    explicit Spot(const SpotProfileDesc& desc) : profile(desc, {}) {}
    double at(double degrees) const {
        return profile.relative_intensity(
            {0, std::sin(radians_of(degrees)), std::cos(radians_of(degrees))});
    }
};

TEST(SpotProfile, ObeysTheLaws) {
    const LampPlacement placement{Affine::rotation_xyz_degrees({20, -70, 110}), {0.6, 0, 0.8}};
    for (const Falloff falloff : k_falloffs)
        for (const auto& [beam, edge] :
             {std::pair{60.0, 0.0}, std::pair{60.0, 20.0}, std::pair{4.0, 4.0},
              std::pair{179.0, 0.0}, std::pair{180.0, 180.0}})
            expect_lamp_profile_laws(SpotProfile({beam, edge, falloff}, placement));
}

TEST(SpotProfile, IsHalfAtTheEdgeOfItsBeam) {
    for (const double edge : {1.0, 20.0, 40.0}) {
        const Spot spot({60, edge});
        EXPECT_NEAR(spot.at(30), 0.5, 1e-12) << edge;
        EXPECT_EQ(spot.at(30 - 0.5 * edge - 1e-6), 1) << edge;
        EXPECT_EQ(spot.at(30 + 0.5 * edge + 1e-6), 0) << edge;
        // A smoothstep, by hand at a quarter of the edge: 3/16 - 2/64.
        EXPECT_NEAR(spot.at(30 + 0.25 * edge), 5.0 / 32, 1e-9) << edge;
    }
}

TEST(SpotProfile, FallsAsTheGltfExtensionSays) {
    const Spot spot({63, 7, Falloff::gltf});
    const double inner = std::cos(radians_of(28)), outer = std::cos(radians_of(35));
    EXPECT_EQ(spot.at(27.9), 1);
    EXPECT_EQ(spot.at(35.1), 0);
    for (const double degrees : {28.5, 30.0, 33.0, 34.9}) {
        // KHR_lights_punctual: lightAngleScale and lightAngleOffset, squared.
        const double scale = 1 / std::max(0.001, inner - outer), offset = -outer * scale;
        const double linear = std::cos(radians_of(degrees)) * scale + offset;
        EXPECT_NEAR(spot.at(degrees), linear * linear, 1e-12);
    }
}

// Cycles' spot (kernel/light/spot.h and, up to 3.4, kernel/light/common.h) in Blender's own terms:
// a smoothstep of (cos - cos(size/2)) / ((1 - cos(size/2)) blend); up to 3.4 times the cosine.
TEST(SpotProfile, FallsAsBlenderShadesIt) {
    for (const auto& [size, blend] :
         {std::pair{70.0, 0.2}, std::pair{45.0, 0.15}, std::pair{75.0, 1.0}, std::pair{120.0, 0.5},
          std::pair{180.0, 0.3}}) {
        // What Blender exports: the outer cone is size/2, the inner one that times 1 - blend.
        const double beam = size / 2 * (2 - blend), edge = size / 2 * blend;
        const Spot spot({beam, edge, Falloff::blender});
        const Spot old({beam, edge, Falloff::blender_3_4});
        const double outer = std::cos(radians_of(size / 2));
        for (double degrees = 0; degrees < 90; degrees += 0.25) {
            const double cosine = std::cos(radians_of(degrees));
            const double t = std::clamp((cosine - outer) / ((1 - outer) * blend), 0.0, 1.0);
            const double smooth = t * t * (3 - 2 * t);
            EXPECT_NEAR(spot.at(degrees), smooth, 1e-9) << size << " " << blend << " " << degrees;
            EXPECT_NEAR(old.at(degrees), cosine * smooth, 1e-9)
                << size << " " << blend << " " << degrees;
        }
    }
}

TEST(SpotProfile, WithoutBlendBlendersEdgeIsHard) {
    const Spot spot({60, 0, Falloff::blender}), old({60, 0, Falloff::blender_3_4});
    EXPECT_EQ(spot.at(29.99), 1);
    EXPECT_NEAR(old.at(29.99), std::cos(radians_of(29.99)), 1e-12);
    EXPECT_EQ(spot.at(30.01), 0);
    EXPECT_EQ(old.at(30.01), 0);
}

TEST(SpotProfile, SolidAngleIsTheIntegral) {
    // A hard edge in closed form: a cone of 2 pi (1 - cos 30 deg).
    EXPECT_NEAR(Spot({60, 0}).profile.solid_angle(), 2 * pi * (1 - std::cos(radians_of(30))),
                1e-12);
    for (const Falloff falloff : k_falloffs)
        for (const auto& [beam, edge] :
             {std::pair{63.0, 7.0}, std::pair{60.0, 60.0}, std::pair{120.0, 20.0}}) {
            const SpotProfile spot({beam, edge, falloff}, {});
            // Midpoints 180/20000 degrees apart; the intensity has no jump: 1e-7 of the whole.
            EXPECT_NEAR(spot.solid_angle(), solid_angle_by_quadrature(spot, 20000, 4), 1e-6)
                << beam << " " << edge;
        }
}

TEST(SpotProfile, BreaksAtBothEndsOfItsEdge) {
    const SpotProfile spot({60, 20}, {});
    // Across the beam, 1 m before it: at tan 20 and tan 40 degrees to both sides.
    std::vector<double> s;
    spot.append_breaks({{-2, 0, 1}, {1, 0, 0}}, {0, 10}, {0, 0, 0}, s);
    for (const double degrees : {-40, -20, 20, 40})
        EXPECT_TRUE(std::ranges::any_of(s, [&](double at) {
            return std::abs(at - (2 + std::tan(radians_of(degrees)))) < 1e-9;
        })) << degrees;
}

}  // namespace
}  // namespace uw::test
