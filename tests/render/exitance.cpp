// ctest labels: analytic metamorphic
// Light on surfaces without their texture (irradiance) and with it (radiant exitance).
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/scene/scene_desc.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

SceneDesc without_water(SceneDesc desc) {
    desc.water.absorption = PerBand{0, 0, 0};
    desc.water.scattering->b = {0, 0, 0};
    return desc;
}

// The paper's scene, a checkerboard of a texture on it, in a small image, of the middle alone if
// `zoom` is more than 1.
SceneDesc textured(int samples, double zoom = 1) {
    SceneDesc desc = read_scene(
        std::filesystem::path(UWVDB_SOURCE_DIR) / "assets/scenes/paper/figure6-components.yaml",
        {});
    const double scale = 64.0 / desc.camera.width;
    desc.camera.width = 64;
    desc.camera.height = 36;
    for (double* value : {&desc.camera.intrinsics.fx, &desc.camera.intrinsics.fy,
                          &desc.camera.intrinsics.cx, &desc.camera.intrinsics.cy})
        *value *= scale;
    desc.camera.intrinsics.fx *= zoom;
    desc.camera.intrinsics.fy *= zoom;
    desc.water = hg_water(0.9);
    desc.render.integrator = RenderDesc::Integrator::volume;
    desc.render.samples = samples;
    return desc;
}

TEST(Exitance, OfOneSurfaceIsIrradianceTimesReflectance) {
    SceneDesc desc = pinhole_scene(8, 6);
    desc.geometry = {plane_at_z(2)};
    desc.geometry[0].reflectance = PerBand{0.7, 0.4, 0.1};
    desc.lamps = {isotropic_lamp({0.5, 0.3, 0}, 50), isotropic_lamp({-0.5, 0, 0.2}, 30)};
    desc.render.samples = 4;
    const PixelResult pixel = TestScene(desc).pixel(3, 2);
    ASSERT_GT(pixel.irradiance[0], 0);
    for (std::size_t band = 0; band < 3; ++band) {
        const double truth = pixel.irradiance[band] * (*desc.geometry[0].reflectance)[band];
        EXPECT_NEAR(pixel.exitance[band], truth, 1e-14 * truth);
    }
}

// Where a pixel shows less than a texel: of more light is of the texture's mean, and the hit of its
// value at the pixel's centre.
TEST(Exitance, HasTheTextureThatIrradianceHasNot) {
    constexpr double k_zoom = 40;
    int lit = 0;
    for (const PixelResult& pixel : TestScene(textured(1, k_zoom)).image()) {
        for (std::size_t band = 0; band < 3; ++band) {
            const double truth = pixel.irradiance[band] * pixel.hit.reflectance[band];
            EXPECT_NEAR(pixel.exitance[band], truth, 1e-14 * truth);
        }
        if (pixel.exitance[1] > 0) ++lit;
    }
    EXPECT_GT(lit, 500);
}

// Without water a Lambertian surface's radiance at the camera is its exitance over pi, whatever
// mixture of lights and paints a pixel holds; the product of their means is not.
TEST(Exitance, IsTheMeanOfProductsAndNotTheProductOfMeans) {
    int mixed = 0;
    for (const PixelResult& pixel : TestScene(without_water(textured(16))).image()) {
        for (std::size_t band = 0; band < 3; ++band) {
            const double truth = std::numbers::pi * pixel.direct[band];
            EXPECT_NEAR(pixel.exitance[band], truth, 1e-12 * truth);
            const double product = pixel.irradiance[band] * pixel.hit.reflectance[band];
            if (std::abs(product / pixel.exitance[band] - 1) > 0.1) ++mixed;
        }
    }
    EXPECT_GT(mixed, 100);
}

TEST(Exitance, BecomesDirectLightOnItsWayToTheCamera) {
    int lit = 0;
    for (const PixelResult& pixel : TestScene(textured(1)).image()) {
        if (pixel.exitance[0] > 0) ++lit;
        const double direct = pixel.exitance[0] / std::numbers::pi * pixel.transmittance[0];
        EXPECT_NEAR(pixel.direct[0], direct, 1e-13 * direct);
    }
    EXPECT_GT(lit, 500);
}

}  // namespace
}  // namespace uw::test
