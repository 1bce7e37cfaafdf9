// ctest labels: unit analytic
#include "media/water/water_types.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"

namespace uw {
namespace {

// Rows of the WOPP table: at its own state (20 deg C, no salt) the printed value, elsewhere the
// printed slopes, between two wavelengths their mean.
TEST(PureWater, AbsorptionFollowsTheTable) {
    EXPECT_DOUBLE_EQ(pure_water_absorption(300, 20, 0), 0.00467);
    EXPECT_DOUBLE_EQ(pure_water_absorption(900, 20, 0), 6.7924);
    EXPECT_NEAR(pure_water_absorption(900, 30, 0), 6.7924 + 10 * -0.003682, 1e-12);
    EXPECT_NEAR(pure_water_absorption(900, 20, 35), 6.7924 + 35 * -0.00250675, 1e-12);
    EXPECT_NEAR(pure_water_absorption(893, 20, 0), 0.5 * (6.35455 + 6.44265), 1e-12);
}

// Pope and Fry 1997, an independent measurement, at 550 and 620 nm: 0.0565 and 0.2755 1/m, 5 %.
TEST(PureWater, AbsorptionAgreesWithPopeAndFry) {
    EXPECT_NEAR(pure_water_absorption(550, 22, 0), 0.0565, 0.05 * 0.0565);
    EXPECT_NEAR(pure_water_absorption(620, 22, 0), 0.2755, 0.05 * 0.2755);
}

TEST(PureWater, AbsorptionIsNeverNegative) {
    for (double nm = 300; nm <= 900; nm += 0.5) {
        EXPECT_GE(pure_water_absorption(nm, -2, 0), 0) << nm;
        EXPECT_GE(pure_water_absorption(nm, 40, 45), 0) << nm;
    }
}

TEST(PureWater, AbsorptionOutsideTheTableIsRefused) {
    EXPECT_DOUBLE_EQ(pure_water_absorption_range().first_nm, 300);
    EXPECT_DOUBLE_EQ(pure_water_absorption_range().last_nm, 900);
    EXPECT_THROW(pure_water_absorption(299.9, 20, 0), InputError);
    EXPECT_THROW(pure_water_absorption(901, 20, 0), InputError);
    EXPECT_THROW(pure_water_absorption(std::numeric_limits<double>::quiet_NaN(), 20, 0),
                 InputError);
}

// By hand: at 500 nm the spectral factor is 1 and 37 PSU adds 30 %; b is 16.064 times beta(90),
// as the integral of 1 + 0.835 cos^2 over the sphere: 4 pi (1 + 0.835/3).
TEST(PureWater, ScatteringByHand) {
    EXPECT_NEAR(water_vsf_90(500, 0), 1.38e-4, 1e-18);
    EXPECT_NEAR(water_vsf_90(500, 37), 1.794e-4, 1e-16);
    EXPECT_NEAR(water_vsf_90(250, 0), 1.38e-4 * 19.9733, 1e-8);  // 2^4.32 = 19.9733
    for (const double nm : {350.0, 450.0, 540.0, 620.0, 800.0})
        // 16.064 is printed to 5 digits
        EXPECT_NEAR(water_scattering(nm, 35) / water_vsf_90(nm, 35), 16.064, 5e-4);
    // An independent theory (Zhang, Hu and He 2009: 1.7068e-3 1/m at 550 nm, 35 PSU, 20 deg C),
    // known to lie about 10 % below Morel's measurements
    EXPECT_NEAR(water_scattering(550, 35), 1.7068e-3, 0.15 * 1.7068e-3);
}

}  // namespace
}  // namespace uw
