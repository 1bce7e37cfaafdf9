// ctest labels: unit analytic
#include "media/water/fournier_forand.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "tests/support/described_phase.h"
#include "tests/support/phase_function_laws.h"
#include "tests/support/phase_test_values.h"

namespace uw {
namespace {

using std::numbers::pi;

TEST(FournierForand, ObeysTheLaws) {
    for (const double n : {1.01, 1.05, 1.10, 1.2, 1.5})
        for (const double mu : {3.1, 3.5835, 4.0, 4.9})
            test::expect_phase_function_laws(*test::fournier_forand(n, mu));
    // delta = 1 at psi = pi exactly, at and beside the second quotient's own 0/0
    for (const double n : {1 + 2 / std::sqrt(3.0), 2.15, 2.16})
        test::expect_phase_function_laws(*test::fournier_forand(n, 3.5));
}

TEST(FournierForand, MatchesTheTestValues) {
    test::expect_phase_column(*test::fournier_forand(1.10, 3.5835),
                              test::phase_test_table("phase_function_test_values.csv"),
                              "FF_1p10_3p5835");
}

// Backscattered fraction in closed form (Fournier and Jonasz 1999), 0.0183 for these parameters.
TEST(FournierForand, BackscatterFraction) {
    const double n = 1.10, mu = 3.5835;
    const auto phase = test::fournier_forand(n, mu);
    const PhaseFunction& p = *phase;
    const double back =
        test::integral_over_sphere([&](double psi) { return psi > pi / 2 ? p.eval(psi) : 0.0; });
    const double nu = (3 - mu) / 2, d = 4 / (3 * (n - 1) * (n - 1)) / 2;
    const double closed =
        1 - (1 - std::pow(d, nu + 1) - 0.5 * (1 - std::pow(d, nu))) / ((1 - d) * std::pow(d, nu));
    EXPECT_NEAR(back, closed, 1e-6);
    EXPECT_NEAR(back, 0.0183, 5e-5);
}

// Through delta = 1 the values follow a straight line within their curvature: the series and the
// direct form agree where they meet (|delta - 1| = 0.05), and at delta = 1 itself nothing breaks.
TEST(FournierForand, IsSmoothThroughDeltaOne) {
    for (const double n : {1.02, 1.10, 1.3})
        for (const double mu : {3.2, 3.5835, 4.5}) {
            const auto phase = test::fournier_forand(n, mu);
            const PhaseFunction& p = *phase;
            const auto at_delta = [&](double delta) {
                return p.eval(2 * std::asin(std::sqrt(0.75 * delta) * (n - 1)));
            };
            EXPECT_TRUE(std::isfinite(at_delta(1)));
            for (const double delta : {0.95, 1.0, 1.05}) {
                // A step of 1e-6 in delta changes p by about 2e-6 of itself; a third-difference
                // leaves rounding, amplified 400 times by the direct form's cancellation.
                const double h = 1e-6;
                const double middle = at_delta(delta);
                const double mean = 0.5 * (at_delta(delta - h) + at_delta(delta + h));
                EXPECT_NEAR(mean / middle, 1, 1e-10) << "n " << n << " mu " << mu << " " << delta;
            }
        }
}

TEST(FournierForand, RefusesImpossibleParameters) {
    EXPECT_THROW(test::fournier_forand(1.0, 3.5), InputError);
    EXPECT_THROW(test::fournier_forand(std::nan(""), 3.5), InputError);
    EXPECT_THROW(test::fournier_forand(1.1, 3.0), InputError);
    EXPECT_THROW(test::fournier_forand(1.1, 5.0), InputError);
}

}  // namespace
}  // namespace uw
