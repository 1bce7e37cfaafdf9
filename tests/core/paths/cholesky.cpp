// ctest labels: unit analytic
#include "core/paths/lattice_fit.h"

#include <gtest/gtest.h>

#include <limits>

namespace uw::test {
namespace {

TEST(CholeskyFactor, SolvesASystem) {
    // The upper triangle is not read.
    const double x = std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> matrix{4, x, x, 2, 5, x, -2, 3, 6};
    CholeskyFactor cholesky;
    ASSERT_TRUE(cholesky.factor(matrix, 3, 1e-9));
    // matrix (1, -2, 3)
    std::vector<double> solution{4 - 4 - 6, 2 - 10 + 9, -2 - 6 + 18};
    cholesky.solve(solution);
    EXPECT_NEAR(solution[0], 1, 1e-12);
    EXPECT_NEAR(solution[1], -2, 1e-12);
    EXPECT_NEAR(solution[2], 3, 1e-12);
}

TEST(CholeskyFactor, RefusesWhatIsSingularOrIndefinite) {
    CholeskyFactor cholesky;
    EXPECT_FALSE(cholesky.factor(std::vector<double>{1, 0, 1, 1}, 2, 1e-9));
    EXPECT_FALSE(cholesky.factor(std::vector<double>{1, 0, 2, 1}, 2, 1e-9));
    EXPECT_FALSE(cholesky.factor(std::vector<double>{0}, 1, 1e-9));
    // Elimination leaves 1e-4 of the last element.
    const std::vector<double> nearly{1, 0, 1, 1.0001};
    EXPECT_FALSE(cholesky.factor(nearly, 2, 1e-3));
    EXPECT_TRUE(cholesky.factor(nearly, 2, 1e-5));
}

}  // namespace
}  // namespace uw::test
