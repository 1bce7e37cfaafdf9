// ctest labels: unit analytic
#include <gtest/gtest.h>

#include <numbers>

#include "core/light/lamp_profile.h"
#include "tests/support/lamp_profile_laws.h"

namespace uw::test {
namespace {

using std::numbers::pi;

TEST(TableProfile, ObeysTheLaws) {
    const LampPlacement placement{Affine::rotation_xyz_degrees({20, -70, 110}), {0.6, 0, 0.8}};
    expect_lamp_profile_laws(TableProfile({{0, 20, 40, 60}, {1, 0.9, 0.4, 0}}, placement));
    expect_lamp_profile_laws(TableProfile({{0, 90, 180}, {0.2, 0.7, 0.1}}, placement));
}

TEST(TableProfile, IsLinearBetweenItsAngles) {
    const TableProfile profile({{0, 20, 40, 60}, {0.5, 0.8, 0.4, 0.2}}, {});
    for (const double sign : {1.0, -1.0}) {
        EXPECT_NEAR(intensity_at(profile, 0), 0.5, 1e-12);
        EXPECT_NEAR(intensity_at(profile, sign * 10), 0.65, 1e-12);
        EXPECT_NEAR(intensity_at(profile, sign * 20), 0.8, 1e-12);
        EXPECT_NEAR(intensity_at(profile, sign * 35), 0.5, 1e-12);
        EXPECT_NEAR(intensity_at(profile, sign * 59.999), 0.2, 1e-4);
        EXPECT_EQ(intensity_at(profile, sign * 60.001), 0);
        EXPECT_EQ(intensity_at(profile, sign * 180), 0);
    }
}

TEST(TableProfile, SolidAngleIsTheIntegral) {
    // 2 pi int (1 - angle / (pi/2)) sin(angle) = 2 pi (1 - 2/pi) up to pi/2.
    EXPECT_NEAR(TableProfile({{0, 90}, {1, 0}}, {}).solid_angle(), 2 * pi - 4, 1e-9);
    EXPECT_NEAR(TableProfile({{0, 90}, {0.25, 0}}, {}).solid_angle(), (2 * pi - 4) / 4, 1e-9);
    const TableProfile hollow({{0, 20, 40, 60}, {0.5, 0.8, 0.4, 0}}, {});
    // Midpoints 180/20000 degrees apart.
    EXPECT_NEAR(hollow.solid_angle(), solid_angle_by_quadrature(hollow, 20000, 4),
                1e-5 * hollow.solid_angle());
}

}  // namespace
}  // namespace uw::test
