// ctest labels: unit analytic
#include "core/light/medium.h"

#include <gtest/gtest.h>

#include <array>

namespace uw {
namespace {

/// Two bands, two phase functions, two constituents; phase functions themselves are not needed.
Medium two_band_medium() {
    Medium medium;
    medium.wavelengths_nm = {620, 450};
    medium.uniform.absorption[0] = 0.3;
    medium.uniform.absorption[1] = 0.02;
    medium.uniform.scattering.resize(2);
    medium.uniform.scattering[0][0] = 0.05;
    medium.uniform.scattering[1][1] = 0.08;
    Constituent silt{"silt", "ppm", {}};
    silt.per_unit.absorption[0] = 0.5;
    silt.per_unit.scattering.resize(2);
    silt.per_unit.scattering[0][0] = 0.25;
    silt.per_unit.scattering[1][0] = 0.25;
    silt.per_unit.scattering[1][1] = 2;
    Constituent dye{"dye", "1", {}};
    dye.per_unit.absorption[1] = 4;
    dye.per_unit.scattering.resize(2);
    medium.constituents = {silt, dye};
    return medium;
}

TEST(OpticalDepth, IsTheUniformWatersAndThatOfEachColumn) {
    const AttenuationTable table(two_band_medium());
    EXPECT_EQ(table.band_count, 2);
    const std::array<double, 2> columns{3, 0.5};
    EXPECT_NEAR(table.optical_depth(0, 10, columns), 0.35 * 10 + 1.0 * 3, 1e-14);
    EXPECT_NEAR(table.optical_depth(1, 10, columns), 0.10 * 10 + 2.0 * 3 + 4 * 0.5, 1e-14);
    const std::array<double, 2> nothing{};
    EXPECT_EQ(table.optical_depth(0, 0, nothing), 0);
}

TEST(OpticalDepth, TransmittancesOfStretchesMultiply) {
    const AttenuationTable table(two_band_medium());
    const std::array<double, 2> first{0.4, 0.1}, second{0.2, 0.3}, both{0.6, 0.4};
    const Spectrum a = table.transmittance(1.5, first), b = table.transmittance(2.5, second);
    const Spectrum whole = table.transmittance(4, both);
    for (std::size_t band = 0; band < 2; ++band) {
        const double tau = table.optical_depth(static_cast<int>(band), 4, both);
        EXPECT_NEAR(whole[band], std::exp(-tau), 1e-11);
        EXPECT_NEAR(whole[band], a[band] * b[band], 1e-11);
    }
    EXPECT_EQ(whole[2], 0);  // there is no third band
}

}  // namespace
}  // namespace uw
