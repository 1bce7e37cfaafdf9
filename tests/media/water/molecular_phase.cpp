// ctest labels: unit analytic
#include "media/water/molecular_phase.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/phase_function_laws.h"
#include "tests/support/phase_test_values.h"

namespace uw {
namespace {

using std::numbers::pi;

TEST(MolecularPhase, ObeysTheLaws) {
    test::expect_phase_function_laws(MolecularPhase(), 0.0);
}

TEST(MolecularPhase, MatchesTheTestValues) {
    test::expect_phase_column(
        MolecularPhase(), test::phase_test_table("phase_function_test_values.csv"), "water_0p835");
}

// Molecules: 1/16.064 (to its digits, 2e-6 relative) at 90 degrees, 1.835 times that at 0 and 180.
TEST(MolecularPhase, ByHand) {
    const MolecularPhase p;
    EXPECT_NEAR(p.eval(pi / 2), 1 / 16.064, 1e-7);
    EXPECT_NEAR(p.eval(0.0) / p.eval(pi / 2), 1.835, 1e-12);
    EXPECT_NEAR(p.eval(pi) / p.eval(pi / 2), 1.835, 1e-12);
}

}  // namespace
}  // namespace uw
