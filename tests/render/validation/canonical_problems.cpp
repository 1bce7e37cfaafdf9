// ctest labels: analytic slow
// The canonical problems of ocean optics with stratified water and below waves.
#include "render/validation/canonical_problems.h"

#include <gtest/gtest.h>

#include <vector>

#include "render/validation/published_figure.h"

namespace uw::test {
namespace {

std::vector<PublishedFigure> figures_of(const char* problem, int rays) {
    std::vector<PublishedFigure> figures;
    append_canonical_problems({.rays = rays, .only = problem}, figures);
    for (const PublishedFigure& figure : figures) {
        EXPECT_TRUE(figure.passed()) << figure.quantity << ": " << figure.ours << " +- "
                                     << figure.error << " for " << figure.published;
        // Or anything would pass; Lu far down comes by rare paths.
        EXPECT_LT(figure.error, figure.quantity.starts_with("Ed") ? 0.04 : 0.2) << figure.quantity;
    }
    return figures;
}

TEST(CanonicalProblems, StratifiedWaterHolds) {
    EXPECT_EQ(figures_of("problem 3", 65536).size(), 9U);
}

TEST(CanonicalProblems, WindBlownSurfaceHolds) {
    EXPECT_EQ(figures_of("problem 5", 65536).size(), 10U);
}

}  // namespace
}  // namespace uw::test
