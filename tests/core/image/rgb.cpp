// ctest labels: unit analytic
#include "core/geometry/mesh.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

TEST(Rgb, UndoesTheEncodingOfSrgb) {
    // IEC 61966-2-1 the other way round: 12.92 L up to 0.0031308, then 1.055 L^(1/2.4) - 0.055.
    for (double linear = 0; linear <= 1; linear += 1.0 / 512) {
        const double encoded =
            linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
        EXPECT_NEAR(linear_from_srgb(encoded), linear, 1e-15) << linear;
    }
}

TEST(Rgb, KnownValues) {
    EXPECT_EQ(linear_from_srgb(0), 0);
    EXPECT_EQ(linear_from_srgb(1), 1);
    EXPECT_NEAR(linear_from_srgb(128.0 / 255), 0.2158605, 5e-8);
    EXPECT_NEAR(linear_from_srgb(10.0 / 255), 10.0 / 255 / 12.92, 1e-15);
}

TEST(Rgb, TheTwoPiecesMeet) {
    EXPECT_NEAR(linear_from_srgb(0.04045), linear_from_srgb(0.0404500001), 1e-7);
}

}  // namespace
}  // namespace uw
