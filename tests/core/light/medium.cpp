// ctest labels: unit
#include "core/light/medium.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

TEST(Medium, AttenuationIsAbsorptionAndAllScattering) {
    OpticalCoefficients coefficients;
    coefficients.absorption[1] = 0.25;
    EXPECT_EQ(coefficients.attenuation(1), 0.25);
    coefficients.scattering.resize(3);
    coefficients.scattering[0][1] = 0.5;
    coefficients.scattering[2][1] = 1;
    coefficients.scattering[2][0] = 8;
    EXPECT_EQ(coefficients.attenuation(1), 1.75);
    EXPECT_EQ(coefficients.attenuation(0), 8);
    EXPECT_EQ(coefficients.attenuation(2), 0);
}

TEST(Medium, CountsItsParts) {
    Medium medium;
    EXPECT_EQ(medium.band_count(), 0);
    medium.wavelengths_nm = {620, 540, 450};
    medium.constituents.resize(2);
    medium.phase_functions.resize(4);
    EXPECT_EQ(medium.band_count(), 3);
    EXPECT_EQ(medium.constituent_count(), 2);
    EXPECT_EQ(medium.phase_count(), 4);
}

}  // namespace
}  // namespace uw
