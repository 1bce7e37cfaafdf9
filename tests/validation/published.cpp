// ctest labels: analytic
// What others have published: a canonical problem of ocean optics with few rays, and photographs.
#include "validation/published.h"

#include <gtest/gtest.h>

#include <string>

namespace uw::test {
namespace {

// Sun, refraction, single and multiple scattering of particles, and what the surface reflects
// back: without that irradiance at albedo 0.9 is 2 to 4 % low.
TEST(Published, CanonicalProblemOfParticlesHolds) {
    int irradiances = 0;
    for (const PublishedFigure& figure :
         compare_with_published({.rays = 16384, .only = "problem 2"})) {
        EXPECT_TRUE(figure.passed()) << figure.source << ": " << figure.quantity << ": "
                                     << figure.ours << " for " << figure.published;
        if (!figure.quantity.starts_with("Ed")) continue;
        EXPECT_LT(figure.error, 0.04) << figure.quantity;  // ten optical depths down
        ++irradiances;
    }
    EXPECT_EQ(irradiances, 6);
}

// The noise floor of the corners; without a port they are 2.6, 0.27 and 14 px off.
TEST(Published, CornersInPhotographsAreWherePortsPutThem) {
    const auto figures = compare_with_published({.only = "none of the problems"});
    ASSERT_EQ(figures.size(), 3U);
    for (const PublishedFigure& figure : figures) {
        EXPECT_TRUE(figure.is_bound);
        EXPECT_TRUE(figure.passed()) << figure.source << ": " << figure.ours;
        // Much less would be other corners.
        EXPECT_GT(figure.ours, 0.95 * figure.published) << figure.source;
    }
}

TEST(PublishedFigure, PassesWithinToleranceAndTwoErrors) {
    PublishedFigure figure;
    figure.published = 2;
    figure.ours = 2.05;
    figure.tolerance = 0.01;
    EXPECT_FALSE(figure.passed());
    figure.error = 0.01;
    EXPECT_TRUE(figure.passed());
    figure.ours = 1;
    EXPECT_FALSE(figure.passed());
    figure.is_bound = true;
    EXPECT_TRUE(figure.passed());
}

}  // namespace
}  // namespace uw::test
