// ctest labels: unit
#include "core/geometry/mesh.h"

#include <gtest/gtest.h>

#include "core/image/image_file.h"

namespace uw {
namespace {

/// One row of grey texels whose linear values are exactly 0 and 1, so that decoding cannot blur
/// what the lookups are tested for.
Texture row(const std::vector<float>& values) {
    return Texture(PixelImage{static_cast<int>(values.size()), 1, 1, values});
}

double red(const Texture& t, double u, TextureFilter filter, TextureWrap wrap) {
    return t.sample(u, 0.5, {filter, wrap, wrap})[0];
}

TEST(Texture, DecodesSrgbAtKnownValues) {
    // IEC 61966-2-1: code 128/255 is 0.21586, 0.04 is on the linear part, 1 is 1.
    const Texture t(PixelImage{4, 1, 3, {128 / 255.F, 0.04F, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0}});
    const Rgb c = t.sample(0.125, 0.5, {TextureFilter::nearest});
    EXPECT_NEAR(c[0], 0.2158605, 1e-6);  // the tabulated digits
    EXPECT_NEAR(c[1], 0.04 / 12.92, 1e-8);
    EXPECT_EQ(c[2], 1.0);
}

TEST(Texture, NearestTakesTheTexelUnderThePoint) {
    const Texture t = row({0, 1, 0, 1});
    const auto at = [&](double u) { return red(t, u, TextureFilter::nearest, TextureWrap::clamp); };
    EXPECT_EQ(at(0.24), 0.0);
    EXPECT_EQ(at(0.26), 1.0);
    EXPECT_EQ(at(0.51), 0.0);
    EXPECT_EQ(at(0.99), 1.0);
}

TEST(Texture, LinearInterpolatesBetweenCentres) {
    const Texture t = row({0, 1, 0, 0});
    const auto at = [&](double u) { return red(t, u, TextureFilter::linear, TextureWrap::clamp); };
    EXPECT_DOUBLE_EQ(at(1.5 / 4), 1.0);
    EXPECT_DOUBLE_EQ(at(1.0 / 4), 0.5);
    EXPECT_DOUBLE_EQ(at(1.75 / 4), 0.75);
    // In both directions: the middle of the four texels is their mean, in linear light.
    const Texture square(PixelImage{2, 2, 1, {1, 0, 0, 0}});
    EXPECT_DOUBLE_EQ(square.sample(0.5, 0.5, {})[0], 0.25);
}

TEST(Texture, WrapsAsAsked) {
    const Texture t = row({1, 0, 0, 0});  // only the first texel is lit
    const auto nearest = [&](double u, TextureWrap wrap) {
        return red(t, u, TextureFilter::nearest, wrap);
    };
    EXPECT_EQ(nearest(5.1, TextureWrap::repeat), 1.0);
    EXPECT_EQ(nearest(-0.9, TextureWrap::repeat), 1.0);
    EXPECT_EQ(nearest(-0.1, TextureWrap::repeat), 0.0);
    EXPECT_EQ(nearest(-7.3, TextureWrap::clamp), 1.0);
    EXPECT_EQ(nearest(1.1, TextureWrap::clamp), 0.0);
    EXPECT_EQ(nearest(-0.1, TextureWrap::mirror), 1.0);
    EXPECT_EQ(nearest(1.1, TextureWrap::mirror), 0.0);
    EXPECT_EQ(nearest(1.9, TextureWrap::mirror), 1.0);
    EXPECT_EQ(nearest(2.1, TextureWrap::mirror), 1.0);
    // At the seam: repeat blends with the other side, clamp with itself.
    EXPECT_DOUBLE_EQ(red(t, 0.0, TextureFilter::linear, TextureWrap::repeat), 0.5);
    EXPECT_DOUBLE_EQ(red(t, 0.0, TextureFilter::linear, TextureWrap::clamp), 1.0);
    EXPECT_DOUBLE_EQ(red(t, 0.0, TextureFilter::linear, TextureWrap::mirror), 1.0);
    // Absurd coordinates stay inside the image.
    for (const double u : {1e300, -1e300, 1e17, -3e18}) {
        for (const TextureWrap wrap :
             {TextureWrap::repeat, TextureWrap::clamp, TextureWrap::mirror}) {
            EXPECT_LE(red(t, u, TextureFilter::linear, wrap), 1.0);
        }
    }
}

}  // namespace
}  // namespace uw
