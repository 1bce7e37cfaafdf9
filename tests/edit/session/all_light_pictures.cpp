// ctest labels: metamorphic slow
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <string>

#include "tests/support/edit_examples.h"

namespace {

using namespace uw;
using namespace uw::test;

class AllLightPictures : public testing::TestWithParam<const char*> {};

// Each lamp has light paths of its own, so that their sum differs by the noise of both pictures:
// by the square root of two times what one of them states, and somewhat more by chance.
TEST_P(AllLightPictures, AreThoseThatRenderGives) {
    const TwoPictures pictures =
        both_pictures_of(GetParam(), 48, 27, RenderDesc::Scattering::multiple);
    std::cout << "RMS " << pictures.rms_difference() / pictures.mean() << ", mean "
              << pictures.mean_difference() / pictures.mean() << ", stated "
              << pictures.stated_error / pictures.mean() << "\n";
    EXPECT_LT(pictures.rms_difference(), 1.5 * pictures.stated_error);
    EXPECT_LT(std::abs(pictures.mean_difference()), 0.02 * pictures.mean());
    // Or anything would pass.
    EXPECT_LT(pictures.stated_error, 0.15 * pictures.mean());
}

// Two lamps in turbid water, the sun and two lamps, a plume between two lamps, and particles that
// hide light.
INSTANTIATE_TEST_SUITE_P(Examples, AllLightPictures,
                         testing::Values("harbour.yaml", "sunlit.yaml", "plume.yaml", "snow.yaml"));

// No light paths here: as exact as other examples.
TEST(CausticPictures, AreThoseThatRenderGives) {
    const TwoPictures pictures =
        both_pictures_of("shallows.yaml", 48, 27, RenderDesc::Scattering::single);
    EXPECT_GT(pictures.mean(), 0);
    EXPECT_LT(pictures.rms_difference(), 1e-3 * pictures.mean());
}

}  // namespace
