// ctest labels: unit
#include "core/geometry/mesh.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace uw {
namespace {

const Rgb k_color{0.8, 0.4, 0.1};

TEST(Reflectance, ThreeBandsAreRedGreenBlueWhateverTheirWavelengths) {
    const Spectrum s = ReflectanceBands({700, 500, 400}).from_rgb(k_color);
    EXPECT_EQ(s[0], 0.8);
    EXPECT_EQ(s[1], 0.4);
    EXPECT_EQ(s[2], 0.1);
    EXPECT_EQ(s[3], 0.0);
}

TEST(Reflectance, OtherCountsInterpolateInWavelengthAndHoldTheEnds) {
    const Spectrum s = ReflectanceBands({380, 450, 495, 540, 600, 620, 750}).from_rgb(k_color);
    const double expected[] = {0.1, 0.1, 0.25, 0.4, 0.4 + 0.4 * 60 / 80, 0.8, 0.8};
    // Rounding of one or two products.
    for (std::size_t band = 0; band < 7; ++band) EXPECT_NEAR(s[band], expected[band], 1e-15);
    for (std::size_t band = 7; band < k_max_bands; ++band) EXPECT_EQ(s[band], 0.0);
}

TEST(Reflectance, GreyStaysGrey) {
    const ReflectanceBands bands({410, 470, 533, 571, 634});
    const Spectrum s = bands.from_rgb({0.3, 0.3, 0.3});
    for (std::size_t band = 0; band < 5; ++band) EXPECT_NEAR(s[band], 0.3, 1e-15);
}

TEST(Reflectance, RefusesBandCountsOutOfRange) {
    EXPECT_THROW(ReflectanceBands({}), std::invalid_argument);
    EXPECT_THROW(ReflectanceBands(std::vector<double>(33, 500.0)), std::invalid_argument);
}

}  // namespace
}  // namespace uw
