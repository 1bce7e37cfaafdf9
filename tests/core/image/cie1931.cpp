// ctest labels: unit analytic
#include "core/image/spectral_bands.h"

#include <gtest/gtest.h>

#include <cmath>

namespace uw {
namespace {

/// XYZ of a spectrum, by the sum over 5 nm that CIE 015 prescribes.
template <typename Spectral>
Xyz tristimulus(const Spectral& radiance) {
    Xyz sum;
    for (int nm = 360; nm <= 830; nm += 5) {
        const Xyz cmf = cie1931_matching_functions(nm);
        sum.x += 5 * cmf.x * radiance(nm);
        sum.y += 5 * cmf.y * radiance(nm);
        sum.z += 5 * cmf.z * radiance(nm);
    }
    return sum;
}

TEST(Cie1931, KnownIntegralsAndPeak) {
    // Published: each function integrates to 106.857, and V(555 nm) = 1.
    const Xyz equal_energy = tristimulus([](double) { return 1.0; });
    EXPECT_NEAR(equal_energy.x, 106.866, 0.02);  // sums of the 5 nm table
    EXPECT_NEAR(equal_energy.y, 106.857, 0.02);
    EXPECT_NEAR(equal_energy.z, 106.892, 0.02);
    EXPECT_EQ(cie1931_matching_functions(555).y, 1);
}

TEST(Cie1931, IlluminantA) {
    // Illuminant A is defined by a formula (CIE 015), and so is its chromaticity: 0.44758, 0.40745.
    const Xyz a = tristimulus([](double nm) {
        return std::pow(560 / nm, 5) * std::expm1(1.435e7 / (2848 * 560)) /
               std::expm1(1.435e7 / (2848 * nm));
    });
    EXPECT_NEAR(a.x / (a.x + a.y + a.z), 0.44758, 2e-5);
    EXPECT_NEAR(a.y / (a.x + a.y + a.z), 0.40745, 2e-5);
}

TEST(Cie1931, LinearBetweenTheTableAndZeroOutside) {
    const double middle = cie1931_matching_functions(557.5).x;
    EXPECT_NEAR(middle, 0.5 * (0.5120501 + 0.5945), 1e-12);
    EXPECT_GT(cie1931_matching_functions(830).y, 0);
    EXPECT_EQ(cie1931_matching_functions(830.1).y, 0);
    EXPECT_EQ(cie1931_matching_functions(359.9).x, 0);
    EXPECT_EQ(cie1931_matching_functions(std::nan("")).x, 0);
}

TEST(Cie1931, MeansOverIntervals) {
    // Linear between 550 and 555 nm: the mean is the value in the middle.
    const Xyz middle = cie1931_matching_functions(552.5);
    const Xyz mean = mean_matching_functions(550, 555);
    EXPECT_NEAR(mean.x, middle.x, 1e-12);
    EXPECT_NEAR(mean.y, middle.y, 1e-12);
    EXPECT_NEAR(mean.z, middle.z, 1e-12);
    // Over several steps of the table: the trapezoidal rule.
    double sum = 0;
    for (int nm = 500; nm < 600; nm += 5)
        sum += 0.5 * (cie1931_matching_functions(nm).y + cie1931_matching_functions(nm + 5).y);
    EXPECT_NEAR(mean_matching_functions(500, 600).y, sum / 20, 1e-12);
    // Half of an interval that reaches out of the visible counts nothing.
    EXPECT_NEAR(mean_matching_functions(830, 840).y, 0, 1e-9);
    EXPECT_NEAR(mean_matching_functions(820, 840).x, 0.5 * mean_matching_functions(820, 830).x,
                1e-9);
}

}  // namespace
}  // namespace uw
