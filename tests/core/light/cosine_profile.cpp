// ctest labels: unit analytic
#include "core/light/lamp_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/lamp_profile_laws.h"

namespace uw::test {
namespace {

using std::numbers::pi;

TEST(CosineProfile, ObeysTheLaws) {
    const LampPlacement placement{Affine::rotation_xyz_degrees({20, -70, 110}), {0.6, 0, 0.8}};
    for (const double fwhm : {3.0, 60.0, 120.0, 175.0})
        expect_lamp_profile_laws(CosineProfile({fwhm}, placement));
}

TEST(CosineProfile, IsHalfAtHalfItsWidth) {
    for (const double fwhm : {10.0, 70.0, 120.0, 170.0}) {
        const CosineProfile profile({fwhm}, {});
        EXPECT_EQ(intensity_at(profile, 0), 1);
        EXPECT_NEAR(intensity_at(profile, 0.5 * fwhm), 0.5, 1e-12) << fwhm;
        EXPECT_NEAR(intensity_at(profile, -0.5 * fwhm), 0.5, 1e-12) << fwhm;
        EXPECT_EQ(intensity_at(profile, 90.1), 0);
        EXPECT_EQ(intensity_at(profile, 180), 0);
    }
    // 120 degrees: the exponent is 1, Lambert's law.
    for (const double degrees : {10.0, 45.0, 80.0})
        EXPECT_NEAR(intensity_at(CosineProfile({120}, {}), degrees), std::cos(degrees * pi / 180),
                    1e-12);
}

TEST(CosineProfile, SolidAngleIsTheIntegral) {
    EXPECT_NEAR(CosineProfile({120}, {}).solid_angle(), pi, 1e-12);  // Lambert: Phi = pi I
    for (const double fwhm : {20.0, 90.0, 150.0}) {
        const CosineProfile profile({fwhm}, {});
        // Midpoints 180/20000 degrees apart, and at 90 degrees a root of the cosine at worst.
        EXPECT_NEAR(profile.solid_angle(), solid_angle_by_quadrature(profile, 20000, 4),
                    1e-5 * profile.solid_angle())
            << fwhm;
    }
}

}  // namespace
}  // namespace uw::test
