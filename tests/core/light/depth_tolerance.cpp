// ctest labels: unit analytic
#include "core/light/medium.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace uw {
namespace {

// Water of 0.1 and 0.4 1/m, silt of 2 and 1 1/m per unit.
Medium two_bands() {
    Medium medium;
    medium.wavelengths_nm = {620, 450};
    medium.uniform.absorption[0] = 0.1;
    medium.uniform.absorption[1] = 0.4;
    Constituent silt{"silt", "ppm", {}};
    silt.per_unit.absorption[0] = 2;
    silt.per_unit.absorption[1] = 1;
    medium.constituents = {silt};
    return medium;
}

TEST(DepthTolerance, CountsAnErrorAsItsOpticalDepthInTheDarkestBand) {
    const DepthTolerance tolerance(two_bands(), 0.01);
    const std::array<double, 1> nothing{}, small{0.0049}, large{-0.0051};
    EXPECT_TRUE(tolerance.allows(small, 0, nothing));
    EXPECT_FALSE(tolerance.allows(large, 0, nothing));
}

TEST(DepthTolerance, CountsItLessBehindWaterAndParticles) {
    const DepthTolerance tolerance(two_bands(), 0.01);
    const std::array<double, 1> nothing{}, silt{0.5}, error{0.007};
    EXPECT_FALSE(tolerance.allows(error, 0, nothing));
    // The clearest band of each: 0.1 1/m of water, 1 1/m of silt.
    const double depth_left = std::log(2 * 0.007 / 0.01);
    EXPECT_FALSE(tolerance.allows(error, 0.99 * depth_left / 0.1, nothing));
    EXPECT_TRUE(tolerance.allows(error, 1.01 * depth_left / 0.1, nothing));
    EXPECT_TRUE(tolerance.allows(error, 0, silt));
}

TEST(DepthTolerance, IsExactUnlessToldOtherwise) {
    EXPECT_TRUE(DepthTolerance().exact());
    EXPECT_TRUE(DepthTolerance(two_bands(), 0).exact());
    EXPECT_FALSE(DepthTolerance(two_bands(), 1e-6).exact());
    EXPECT_EQ(DepthTolerance(two_bands(), 0.1), DepthTolerance(two_bands(), 0.1));
    EXPECT_NE(DepthTolerance(two_bands(), 0.1), DepthTolerance(two_bands(), 0.2));
}

}  // namespace
}  // namespace uw
