// ctest labels: unit analytic
#include "media/phase/henyey_greenstein.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "tests/support/phase_function_laws.h"
#include "tests/support/phase_test_values.h"

namespace uw {
namespace {

TEST(HenyeyGreenstein, ObeysTheLaws) {
    for (const double g : {-0.99, -0.6, 0.0, 0.3, 0.9, 0.924, 0.999})
        test::expect_phase_function_laws(HenyeyGreenstein(g));
}

TEST(HenyeyGreenstein, MatchesTheTestValues) {
    test::expect_phase_column(HenyeyGreenstein(0.924),
                              test::phase_test_table("phase_function_test_values.csv"), "HG_0p924");
}

// The mean cosine of Henyey-Greenstein is its parameter.
TEST(HenyeyGreenstein, MeanCosineIsItsParameter) {
    for (const double g : {-0.6, 0.0, 0.5, 0.924}) {
        const HenyeyGreenstein p(g);
        EXPECT_NEAR(
            test::integral_over_sphere([&](double psi) { return p.evaluate(psi) * std::cos(psi); }),
            g, 1e-6);
    }
}

TEST(HenyeyGreenstein, RefusesImpossibleParameters) {
    for (const double g : {-1.0, 1.0, 2.0, std::nan("")})
        EXPECT_THROW(HenyeyGreenstein{g}, InputError);
}

}  // namespace
}  // namespace uw
