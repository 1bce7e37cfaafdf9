// ctest labels: metamorphic slow
//
// In water that absorbs nothing, over a white floor and under a uniform sky, light is in
// equilibrium: its radiance is n^2 that of the sky everywhere and in every direction, scattered,
// reflected by the floor and by the surface from below any number of times. Only then does as much
// leave as enters. To a thousandth, which light paths take minutes to tell.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/scene/sky_desc.h"
#include "tests/support/film_rendering.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

constexpr double k_index_in_equilibrium = 1.34, k_radiance_of_sky = 2;
constexpr int k_pixels = 90;  // of the images, in each direction

/// 1.2 m below the surface and 0.5 m above the floor; y points down. In three bands the water
/// scatters much, some and nothing, evenly in all directions: one direction of the sky stands for a
/// part of it, so that a forward peak would make radiance uneven, though not more or less of it.
SceneDesc in_equilibrium() {
    SceneDesc desc = pinhole_scene(k_pixels, k_pixels);
    desc.water.surface = WaterSurfaceDesc{{0, -1.2, 0}, {0, -1, 0}, k_index_in_equilibrium};
    desc.water.absorption = PerBand{0, 0, 0};
    desc.water.scattering->b = {0.4, 0.1, 0};
    desc.water.scattering->phase.function = HenyeyGreensteinDesc{0};
    desc.geometry = {plane({0, 0.5, 0}, {0, -1, 0})};
    desc.geometry[0].reflectance = PerBand(3, 1.0);
    SkyDesc sky;
    sky.irradiance = PerBand(3, std::numbers::pi * k_radiance_of_sky);
    sky.samples = 64;
    sky.where = "test";
    LampDesc lamp;
    lamp.name = "sky";
    lamp.sky = std::make_shared<const SkyDesc>(sky);
    lamp.direction = -desc.water.surface->normal;
    lamp.sun = SunDesc{.surface = *desc.water.surface};
    lamp.intensity = PerBand(3, 0.0);
    lamp.fixed_to_camera = false;
    desc.lamps = {lamp};
    desc.render.integrator = RenderDesc::Integrator::path;
    return desc;
}

// Two cameras, 60 degrees wide, one that looks down and one that looks up into the surface, in
// which it sees Snell's window, its edge, and the floor mirrored around.
TEST(LightEquilibrium, ClosesToAThousandth) {
    SceneDesc desc = in_equilibrium();
    desc.render.samples = 256;
    // Of the sum over both images.
    const double truth = k_radiance_of_sky * k_index_in_equilibrium * k_index_in_equilibrium * 2 *
                         k_pixels * k_pixels;
    std::array<double, 3> all{}, variances{};
    for (const double tilt : {-90.0, 60.0}) {
        desc.camera.world_from_camera = Affine::rotation_xyz_degrees({tilt, 0, 0});
        const RenderedFilm film(desc);
        for (int y = 0; y < k_pixels; ++y)
            for (int x = 0; x < k_pixels; ++x) {
                for (int b = 0; b < 3; ++b) {
                    const auto band = static_cast<std::size_t>(b);
                    all[band] += film.total(x, y, b) / truth;
                    variances[band] += std::pow(film.value(Layer::error, x, y, b) / truth, 2);
                }
            }
    }
    EXPECT_LT(std::sqrt(variances[1]), 5e-4);  // half of what the means are held to
    for (std::size_t b = 0; b < 3; ++b) {
        EXPECT_NEAR(all[b], 1, 1e-3) << b;
        EXPECT_NEAR(all[b], 1, 3 * std::sqrt(variances[b])) << b;
    }
}

}  // namespace
}  // namespace uw::test
