// ctest labels: unit analytic
#include "camera/lens_model.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace uw {
namespace {

TEST(Polynomial, FirstRootIsNotSteppedOver) {
    // (x - 1)(x - 1.0000001)(x - 5): the first two lie closer than any coarse step.
    const double a = 1, b = 1.0000001, c = 5;
    const std::array<double, 4> cubic{-a * b * c, a * b + b * c + a * c, -(a + b + c), 1};
    const auto root = first_positive_root(cubic, 1e10);
    ASSERT_TRUE(root);
    // Near a pair this close, coefficients rounded to 1e-16 move the root by sqrt(1e-16).
    EXPECT_NEAR(*root, 1, 5e-8);
    EXPECT_FALSE(first_positive_root(std::array<double, 3>{1, 0, 1}, 1e10));
    EXPECT_FALSE(first_positive_root(std::array<double, 2>{-3, 1}, 2));
}

/// The coefficients of the polynomial with these roots.
std::vector<double> polynomial_with_roots(const std::vector<double>& roots) {
    std::vector<double> c{1};
    for (const double root : roots) {
        c.insert(c.begin(), 0.0);
        for (std::size_t i = 0; i + 1 < c.size(); ++i) c[i] -= root * c[i + 1];
    }
    return c;
}

TEST(Polynomial, FindsTheSmallestPositiveRoot) {
    for (const auto& [roots, first] : std::vector<std::pair<std::vector<double>, double>>{
             {{2}, 2}, {{-3, 5}, 5}, {{7, 4, 1.5}, 1.5}, {{-1, -2, 0.25, 3, 8}, 0.25}}) {
        const auto root = first_positive_root(polynomial_with_roots(roots), 100);
        ASSERT_TRUE(root);
        EXPECT_NEAR(*root, first, 1e-12);
    }
}

TEST(Polynomial, LooksNoFurtherThanItsLimit) {
    const std::vector<double> c = polynomial_with_roots({3, 6});
    EXPECT_FALSE(first_positive_root(c, 2.999));
    EXPECT_NEAR(first_positive_root(c, 3.001).value(), 3, 1e-12);
}

TEST(Polynomial, TouchesZeroFromBelowAndGoesOn) {
    EXPECT_NEAR(first_positive_root(polynomial_with_roots({2, 2, 5}), 100).value(), 5, 1e-7);
}

TEST(Polynomial, ConstantsHaveNoRoots) {
    EXPECT_FALSE(first_positive_root({}, 10));
    EXPECT_FALSE(first_positive_root(std::array<double, 1>{0}, 10));
    EXPECT_FALSE(first_positive_root(std::array<double, 3>{4, 0, 0}, 10));
}

TEST(Polynomial, OfHighDegreeAndLargeNumbers) {
    // x^16 = 1e12: the root is 1e12^(1/16).
    std::vector<double> c(17, 0.0);
    c[0] = -1e12;
    c[16] = 1;
    EXPECT_NEAR(first_positive_root(c, 1e10).value(), std::pow(1e12, 1.0 / 16), 1e-12);
    const double huge = std::numeric_limits<double>::max();
    EXPECT_NO_FATAL_FAILURE(
        first_positive_root(std::array<double, 4>{huge, -huge, huge, -huge}, 1e10));
}

}  // namespace
}  // namespace uw
