// ctest labels: unit
#include "render/snow/snow_model.h"

#include <gtest/gtest.h>

#include "tests/support/hg_medium.h"

namespace uw::test {
namespace {

TEST(SnowMedium, WithoutTheSnowThatWasAddedIsTheWater) {
    SnowDesc snow;
    snow.mean = SnowDesc::Mean::added;
    snow.number = 2.3e6;
    snow.least = 4.4e-5;
    snow.greatest = 0.035;
    snow.exponent = 4.1;
    snow.reflectance = {0.2, 0.7, 0.002};
    Medium water = hg_medium(0.4, {0.3, 1e-3, 0.1}, {545.0, 0.02, 0.0});
    const Medium before = water;
    add_snow(snow, water);
    EXPECT_GT(water.uniform.total_scattering()[2], 0);
    const Medium after = without_snow(snow, water);
    for (std::size_t b = 0; b < 3; ++b) {
        // Nothing of the other phase functions, to the bit: its rounding might be below zero.
        for (std::size_t m = 1; m < after.phase_functions.size(); ++m)
            EXPECT_EQ(after.uniform.scattering[m][b], 0) << "phase function " << m;
        EXPECT_EQ(after.uniform.scattering[0][b], before.uniform.scattering[0][b]);
        EXPECT_NEAR(after.uniform.attenuation(b), water.uniform.attenuation(b), 1e-9);
    }
}

}  // namespace
}  // namespace uw::test
