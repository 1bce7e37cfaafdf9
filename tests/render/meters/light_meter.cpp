// ctest labels: analytic
// Light meters in water that scatters nothing, where all they read has a closed form.
#include "render/meters/light_meter.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "core/scene/sky_desc.h"
#include "render/renderer.h"
#include "tests/support/fresnel_by_angles.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

using std::numbers::pi;

// y points down; the surface is at y = 0, a floor of reflectance 0.5 at y = 4.
SceneDesc clear_water() {
    SceneDesc desc = pinhole_scene(8, 6);
    desc.camera.world_from_camera = Affine::translation({0, 1, 0});
    desc.water.surface = WaterSurfaceDesc{{0, 0, 0}, {0, -1, 0}, 1.34};
    desc.water.scattering->b = {0, 0, 0};
    desc.geometry = {plane({0, 4, 0}, {0, -1, 0})};
    return desc;
}

MeterReading reading_of(const SceneDesc& desc, const Point3& x) {
    Renderer renderer;
    renderer.set_scene(SceneDesc(desc));
    return LightMeter(renderer.assemble()).read(x, {0, -1, 0}, 16384);
}

TEST(LightMeter, ReadsASunAndAFloor) {
    SceneDesc desc = clear_water();
    desc.water.absorption = PerBand{0, 0.1, 0.2};
    const double angle = 0.9;
    LampDesc sun;
    sun.name = "sun";
    sun.direction = {std::sin(angle), std::cos(angle), 0};
    sun.sun = SunDesc{.surface = *desc.water.surface};
    sun.intensity = PerBand{1, 1, 1};
    sun.fixed_to_camera = false;
    desc.lamps = {sun};
    const MeterReading reading = reading_of(desc, {0.3, 3, 0.2});
    const double cosine = std::sqrt(1 - std::pow(std::sin(angle) / 1.34, 2));
    const double below = std::cos(angle) * fresnel_by_angles(angle, 1, 1.34).mean();
    for (std::size_t b = 0; b < 3; ++b) {
        const double c = 0.1 * static_cast<double>(b);
        const double down = below * std::exp(-3 * c / cosine);
        const double floor = 0.5 / pi * below * std::exp(-4 * c / cosine);
        // What the floor and the surface send to each other comes on top.
        EXPECT_GE(reading.down.mean[b], (1 - 1e-9) * down) << b;
        EXPECT_LT(reading.down.mean[b], 1.4 * down) << b;
        EXPECT_GE(reading.scalar_down.mean[b], (1 - 1e-9) * down / cosine) << b;
        EXPECT_GT(reading.radiance_up.mean[b], 0.99 * floor * std::exp(-c)) << b;
        EXPECT_LT(reading.radiance_up.mean[b], 1.4 * floor * std::exp(-c)) << b;
    }
    // Without absorption light is lost through the surface alone: what enters leaves. The floor is
    // diffuse, so that E_u is pi L_u and half of what falls on it.
    const double floor = reading.radiance_up.mean[0];
    EXPECT_NEAR(reading.up.mean[0], pi * floor,
                3 * (reading.up.error[0] + pi * reading.radiance_up.error[0]));
    EXPECT_NEAR(reading.down.mean[0], 2 * reading.up.mean[0],
                3 * (reading.down.error[0] + 2 * reading.up.error[0]));
    // Diffuse light from below is reflected by 1 - T / n^2, T that of diffuse light from above.
    constexpr double k_internal = 0.480;
    EXPECT_NEAR(reading.down.mean[0], below / (1 - 0.5 * k_internal), 0.01 * below);
    EXPECT_LT(reading.up.error[0], 0.01 * reading.up.mean[0]);
}

// Without absorption, where the floor, of reflectance 0.5, is all that sends light up: L_u is the
// same at all depths.
TEST(LightMeter, ReadsWhatLeavesTheWater) {
    SceneDesc desc = clear_water();
    desc.water.absorption = PerBand{0, 0, 0};
    const double angle = 0.9, n = 1.34;
    LampDesc sun;
    sun.name = "sun";
    sun.direction = {std::sin(angle), std::cos(angle), 0};
    sun.sun = SunDesc{.surface = *desc.water.surface};
    sun.intensity = PerBand{1, 2, 0};
    sun.fixed_to_camera = false;
    desc.lamps = {sun};
    Renderer renderer;
    renderer.set_scene(SceneDesc(desc));
    const auto leaving = LightMeter(renderer.assemble()).read_water_leaving({0.3, 3, 0.2}, 16384);
    ASSERT_TRUE(leaving);
    EXPECT_NEAR(leaving->irradiance[0], std::cos(angle), 1e-12);
    EXPECT_NEAR(leaving->irradiance[1], 2 * std::cos(angle), 1e-12);
    EXPECT_EQ(leaving->reflectance.mean[2], 0);
    // Diffuse light from below is reflected by k_internal, as above.
    constexpr double k_internal = 0.480;
    const double radiance =
        0.5 / pi * fresnel_by_angles(angle, 1, n).mean() * std::cos(angle) / (1 - 0.5 * k_internal);
    const double leaves = (1 - std::pow((n - 1) / (n + 1), 2)) / (n * n);
    EXPECT_NEAR(leaving->radiance.mean[0] / (leaves * radiance), 1,
                0.005 + 3 * leaving->radiance.error[0] / leaving->radiance.mean[0]);
    EXPECT_NEAR(leaving->reflectance.mean[1], leaving->reflectance.mean[0],
                0.02 * leaving->reflectance.mean[0]);
    EXPECT_LT(leaving->radiance.error[0], 0.01 * leaving->radiance.mean[0]);
    // Without light from the air, or an index, there is no such reflectance.
    desc.lamps.clear();
    renderer.set_scene(SceneDesc(desc));
    EXPECT_FALSE(LightMeter(renderer.assemble()).read_water_leaving({0.3, 3, 0.2}, 16));
}

TEST(LightMeter, KnowsWhatTheSkySendsToTheSurface) {
    SceneDesc desc = clear_water();
    SkyDesc sky;
    sky.irradiance = PerBand{3, 2, 1};
    sky.where = "test";
    LampDesc lamp;
    lamp.name = "sky";
    lamp.sky = std::make_shared<const SkyDesc>(sky);
    lamp.direction = -desc.water.surface->normal;
    lamp.sun = SunDesc{.surface = *desc.water.surface};
    lamp.intensity = PerBand(3, 0.0);
    lamp.fixed_to_camera = false;
    desc.lamps = {lamp};
    Renderer renderer;
    renderer.set_scene(SceneDesc(desc));
    const auto leaving = LightMeter(renderer.assemble()).read_water_leaving({0.3, 3, 0.2}, 16);
    ASSERT_TRUE(leaving);
    EXPECT_NEAR(leaving->irradiance[0], 3, 1e-9);
    EXPECT_NEAR(leaving->irradiance[2], 1, 1e-9);
}

TEST(LightMeter, ReadsALampByItsDistance) {
    SceneDesc desc = clear_water();
    desc.geometry.clear();
    desc.water.surface.reset();
    desc.lamps = {isotropic_lamp({0, 0, 0}, 5)};
    desc.lamps[0].fixed_to_camera = false;
    const MeterReading reading = reading_of(desc, {0.6, 0.8, 0});
    constexpr std::array k_absorption{0.35, 0.08, 0.05};
    for (std::size_t b = 0; b < 3; ++b) {
        const double irradiance = 5 * std::exp(-k_absorption[b]);
        EXPECT_NEAR(reading.scalar_down.mean[b], irradiance, 1e-9);
        EXPECT_NEAR(reading.down.mean[b], 0.8 * irradiance, 1e-9);
        EXPECT_EQ(reading.up.mean[b], 0);
        EXPECT_EQ(reading.down.error[b], 0);
    }
}

}  // namespace
}  // namespace uw::test
