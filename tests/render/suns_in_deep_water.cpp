// ctest labels: analytic
// What water scatters of a sun, where bands differ by orders of magnitude.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/light/integrator.h"
#include "tests/support/suns.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

const WaterSurfaceDesc k_surface{{0, -1.2, 0}, {0, -1, 0}};

double hg_phase(double cosine) {  // of hg_water(0.9)
    constexpr double g = 0.9;
    return (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

/// A camera at the origin that looks at the sky.
Affine look_up() {
    return {Matrix3(Vector3(1, 0, 0), Vector3(0, 0, 1), Vector3(0, -1, 0)), Vector3(0, 0, 0)};
}

class SunInDeepWater : public testing::TestWithParam<RenderDesc::Integrator> {};

// Light of a dense band ends within centimetres, of a clear one it reaches kilometres or up to the
// surface, and each is to be integrated on its own scale.
TEST_P(SunInDeepWater, IsScatteredInBandsOfAnyAttenuation) {
    struct Water {
        PerBand absorption, scattering;
        bool looks_up;  // at a low sun's light, which gets brighter along the ray
    };
    const PerBand black{0.0018, 18, 0.0011}, scattering_of_black{6e-6, 0.0057, 0.025};
    for (const auto& [absorption, scattering, looks_up] :
         {Water{black, scattering_of_black, false}, Water{black, scattering_of_black, true},
          Water{{1.2e-6, 0, 8.7e-5}, {2.5e-5, 2.5e-5, 2.5e-5}, false}}) {
        SceneDesc desc = pinhole_scene(24, 18);
        desc.water.surface = k_surface;
        desc.lamps = {slanting_sun()};
        desc.lamps[0].sun->surface = k_surface;
        if (looks_up) {
            desc.lamps[0].direction = glm::normalize(Vector3(1, 0.3, 0));
            desc.camera.world_from_camera = look_up();
        }
        desc.water.absorption = absorption;
        desc.water.scattering->b = scattering;
        desc.render.integrator = GetParam();
        const TestScene scene(desc);
        const Sunlight sun{desc.lamps[0].direction, *desc.water.surface};
        for (const auto& [x, y] : {std::pair{2, 1}, {12, 9}, {20, 16}}) {
            const PixelResult pixel = scene.pixel(x, y);
            const Ray ray = *scene.assembled().camera->refracted_ray(x + 0.5, y + 0.5);
            const double begin = sun.length_to(ray.origin), slope = sun.slope(ray.direction);
            for (std::size_t b = 0; b < 3; ++b) {
                const double c = absorption[b] + scattering[b], rate = c * (1 + slope);
                const double end = slope < 0 ? std::min(k_far, -begin / slope) : k_far;
                const double expected = desc.lamps[0].intensity->at(b) * scattering[b] *
                                        hg_phase(-glm::dot(sun.direction, ray.direction)) *
                                        std::exp(-c * begin) * -std::expm1(-rate * end) / rate;
                // Gauss panels of 1.5 optical depths, as in water of one attenuation.
                EXPECT_NEAR(pixel.backscatter[b], expected, 2e-5 * expected)
                    << "pixel " << x << ", " << y << ", band " << b;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Integrators, SunInDeepWater,
                         testing::Values(RenderDesc::Integrator::volume,
                                         RenderDesc::Integrator::reference));

}  // namespace
}  // namespace uw::test
