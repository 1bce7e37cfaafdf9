// ctest labels: unit analytic
#include "media/water/water_types.h"

#include <gtest/gtest.h>

#include <cmath>

namespace uw {
namespace {

TEST(Kopelevich, ScatteringAtHisWavelength) {
    EXPECT_DOUBLE_EQ(kopelevich_small_scattering(550), 1.34);
    EXPECT_DOUBLE_EQ(kopelevich_large_scattering(550), 0.312);
}

TEST(Kopelevich, ScatteringIsAPowerOfTheWavelength) {
    // Half the wavelength: 2^1.7 and 2^0.3 times as much.
    for (const double nm : {400.0, 550.0, 700.0}) {
        EXPECT_NEAR(kopelevich_small_scattering(nm / 2) / kopelevich_small_scattering(nm),
                    3.2490095854249423, 1e-13);
        EXPECT_NEAR(kopelevich_large_scattering(nm / 2) / kopelevich_large_scattering(nm),
                    1.2311444133449163, 1e-13);
    }
}

TEST(Kopelevich, MineralAbsorptionFallsByEEachEightyNanometres) {
    EXPECT_DOUBLE_EQ(mineral_mass_absorption(443), 0.041);
    EXPECT_NEAR(mineral_mass_absorption(443 + 1 / 0.0123), 0.041 / std::exp(1.0), 1e-15);
    EXPECT_NEAR(mineral_mass_absorption(443 - 1 / 0.0123), 0.041 * std::exp(1.0), 1e-15);
}

}  // namespace
}  // namespace uw
