// ctest labels: metamorphic threads
#include <gtest/gtest.h>

#include <cstring>

#include "core/base/parallel.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

SceneDesc lit_box() {
    SceneDesc desc = pinhole_scene(24, 18);
    desc.geometry = {plane_at_z(4), box({0.1, -0.2, 1.0}, {0.4, 0.1, 1.3})};
    desc.lamps = {isotropic_lamp({1, -0.5, 0}, 50)};
    desc.render.samples = 4;
    return desc;
}

TEST(RenderLaws, OneThreadAndTwoGiveTheSameBits) {
    const auto render = [](int threads) {
        const ThreadLimit limit(threads);
        return TestScene(lit_box()).image();
    };
    const std::vector<PixelResult> one = render(1), two = render(2);
    ASSERT_EQ(one.size(), two.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(std::memcmp(&one[i].backscatter, &two[i].backscatter, sizeof(Spectrum)), 0);
        EXPECT_EQ(std::memcmp(&one[i].direct, &two[i].direct, sizeof(Spectrum)), 0);
        EXPECT_EQ(one[i].depth_z, two[i].depth_z);
    }
}

TEST(RenderLaws, TwiceTheLampIsTwiceTheImage) {
    SceneDesc bright = lit_box();
    bright.lamps = {isotropic_lamp({1, -0.5, 0}, 100)};
    const std::vector<PixelResult> dim = TestScene(lit_box()).image();
    const std::vector<PixelResult> twice = TestScene(bright).image();
    for (std::size_t i = 0; i < dim.size(); ++i) {
        for (std::size_t band = 0; band < 3; ++band) {
            // A power of two changes only exponents: the images are equal to the bit.
            EXPECT_EQ(twice[i].backscatter[band], 2 * dim[i].backscatter[band]);
            EXPECT_EQ(twice[i].direct[band], 2 * dim[i].direct[band]);
        }
    }
}

TEST(RenderLaws, LampsAddUpToTheTotal) {
    SceneDesc desc = lit_box();
    desc.lamps.push_back(isotropic_lamp({-0.8, 0.1, 0.2}, 20));
    desc.lamps.back().name = "second";
    const TestScene scene(desc);
    for (const PixelResult& pixel : scene.image()) {
        for (std::size_t band = 0; band < 3; ++band) {
            const double total = pixel.direct[band] + pixel.backscatter[band];
            EXPECT_NEAR(pixel.lamps[0][band] + pixel.lamps[1][band], total, 1e-12 * total);
        }
    }
}

TEST(RenderLaws, WallHidesTheLampBehindIt) {
    SceneDesc desc = lit_box();
    desc.lamps = {isotropic_lamp({0.4, -0.3, 5}, 50)};  // behind the plane z = 4
    for (const PixelResult& pixel : TestScene(desc).image()) {
        EXPECT_EQ(pixel.direct[0], 0);
        EXPECT_EQ(pixel.backscatter[0], 0);
        EXPECT_EQ(pixel.lit, 0);
    }
}

TEST(RenderLaws, CleanLayerIsTheSurfaceWithoutWater) {
    SceneDesc water = lit_box();
    SceneDesc clear = lit_box();
    clear.water.absorption = PerBand{0, 0, 0};
    clear.water.scattering->b = {0, 0, 0};
    const std::vector<PixelResult> in_water = TestScene(water).image();
    const std::vector<PixelResult> in_vacuum = TestScene(clear).image();
    for (std::size_t i = 0; i < in_water.size(); ++i) {
        for (std::size_t band = 0; band < 3; ++band) {
            EXPECT_NEAR(in_water[i].clean[band], in_vacuum[i].direct[band],
                        1e-12 * in_water[i].clean[band]);
            EXPECT_EQ(in_vacuum[i].backscatter[band], 0);
        }
    }
}

}  // namespace
}  // namespace uw::test
