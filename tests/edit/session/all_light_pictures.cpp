// ctest labels: metamorphic slow
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/edit_examples.h"

namespace {

using namespace uw;
using namespace uw::test;

// Each lamp has light paths of its own, so that their sum differs by the noise of both pictures.
void expect_same_but_for_noise(const std::string& scene) {
    const TwoPictures pictures = both_pictures_of(scene, 48, 27);
    EXPECT_LT(pictures.rms_difference(), 0.06 * pictures.mean());
    EXPECT_LT(std::abs(pictures.mean_difference()), 0.02 * pictures.mean());
}

TEST(AllLightPictures, OfTheHarbourAreThoseThatRenderGives) {
    expect_same_but_for_noise("harbour.yaml");
}

// No light paths here: as exact as other examples.
TEST(AllLightPictures, OfWavesAreThoseThatRenderGives) {
    const TwoPictures pictures = both_pictures_of("shallows.yaml", 48, 27);
    EXPECT_GT(pictures.mean(), 0);
    EXPECT_LT(pictures.rms_difference(), 1e-3 * pictures.mean());
}

TEST(AllLightPictures, OfSunlitWaterAreThoseThatRenderGives) {
    expect_same_but_for_noise("sunlit.yaml");
}

}  // namespace
