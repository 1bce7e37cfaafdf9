// ctest labels: unit analytic
#include "render/snow/snow_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/adaptive_quadrature.h"

namespace uw {
namespace {

constexpr double k_least = 1e-4, k_greatest = 1e-2;

/// int D^power dD from a to b by quadrature, in ln D.
double integral(double power, double a, double b) {
    const double greatest = std::max(std::pow(a, power + 1), std::pow(b, power + 1));
    return test::AdaptiveQuadrature::integrate([&](double x) { return std::exp((power + 1) * x); },
                                               std::log(a), std::log(b), 1e-9 * greatest);
}

TEST(JungeSizes, SharesAndAreasAreThoseOfThePowerLaw) {
    // 1 and 3 are where the integrals become logarithms.
    for (const double exponent : {0.0, 1.0, 2.5, 3.0, 4.0}) {
        const JungeSizes sizes(exponent, k_least, k_greatest);
        const double a = 2e-4, b = 3e-3;
        EXPECT_NEAR(sizes.fraction(a, b) * integral(-exponent, k_least, k_greatest) /
                        integral(-exponent, a, b),
                    1, 1e-6)
            << exponent;
        EXPECT_NEAR(sizes.mean_area(a, b) / (std::numbers::pi / 4 * integral(2 - exponent, a, b) /
                                             integral(-exponent, a, b)),
                    1, 1e-6)
            << exponent;
    }
}

TEST(JungeSizes, QuantilesInvertTheFraction) {
    for (const double exponent : {0.0, 1.0, 2.5, 4.0, 10.0}) {
        const JungeSizes sizes(exponent, k_least, k_greatest);
        const double a = 2e-4, b = 4e-4;  // an octave, as they are drawn
        EXPECT_NEAR(sizes.quantile(0, a, b), a, 1e-12 * a);
        EXPECT_NEAR(sizes.quantile(1, a, b), b, 1e-12 * b);
        for (const double u : {0.1, 0.5, 0.93}) {
            const double diameter = sizes.quantile(u, a, b);
            EXPECT_NEAR(sizes.fraction(a, diameter) / sizes.fraction(a, b), u, 1e-9) << exponent;
        }
    }
}

/// The number above a diameter falls as its power 1 - exponent, far below the greatest.
TEST(JungeSizes, CumulativeNumbersAreHyperbolic) {
    const JungeSizes sizes(4, 1e-6, 1);
    EXPECT_NEAR(sizes.fraction(1e-4, 1) / sizes.fraction(1e-5, 1), 1e-3, 1e-9);
}

}  // namespace
}  // namespace uw
