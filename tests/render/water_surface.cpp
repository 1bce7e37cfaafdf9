// ctest labels: analytic metamorphic
// A water surface that light meets: lamps and surfaces mirrored in it, the sky and a sun refracted
// by it, in closed form and by every integrator. y points down: the water begins at y = -1.2.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "core/base/error.h"
#include "core/light/submerged.h"
#include "core/scene/sky_desc.h"
#include "core/scene/waves_desc.h"
#include "tests/support/adaptive_quadrature.h"
#include "tests/support/film_rendering.h"
#include "tests/support/fresnel_by_angles.h"
#include "tests/support/message_of.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

using std::numbers::pi;

constexpr double k_water_index = 1.34, k_far_wall = 4, k_ceiling = -1.2, k_eccentricity = 0.9;
// The coefficients of hg_water.
constexpr std::array k_attenuation_below{0.55, 0.30, 0.30};
constexpr std::array k_scattering_below{0.20, 0.22, 0.25};

/// 60 degrees wide, `tilt` degrees up.
SceneDesc scene_below(double tilt = 0) {
    SceneDesc desc = pinhole_scene(24, 18);
    desc.camera.world_from_camera = Affine::rotation_xyz_degrees({tilt, 0, 0});
    desc.water.surface = WaterSurfaceDesc{{0, k_ceiling, 0}, {0, -1, 0}, k_water_index};
    desc.geometry = {plane_at_z(k_far_wall)};
    return desc;
}

SceneDesc lit_from(const Point3& lamp, double tilt = 0) {
    SceneDesc desc = scene_below(tilt);
    desc.lamps = {isotropic_lamp(lamp, 5)};
    desc.lamps[0].fixed_to_camera = false;
    return desc;
}

Point3 mirror_image(const Point3& x) {
    return {x.x, 2 * k_ceiling - x.y, x.z};
}

/// Of light from the water that meets the surface in this direction.
double fresnel_reflectance(const Vector3& direction) {
    const double angle = std::acos(std::abs(direction.y) / glm::length(direction));
    if (k_water_index * std::sin(angle) >= 1) return 1;
    return 1 - fresnel_by_angles(angle, k_water_index, 1).mean();
}

double phase_below(double cosine) {
    return (1 - k_eccentricity * k_eccentricity) /
           (4 * pi *
            std::pow(1 + k_eccentricity * k_eccentricity - 2 * k_eccentricity * cosine, 1.5));
}

/// What a lamp of 5 W/sr at `from`, or its image, throws on the wall at x, without reflection.
double light_on_wall(const Point3& from, const Point3& x, std::size_t band) {
    const double radius = distance(from, x);
    return 5 * (x.z - from.z) / std::pow(radius, 3) * std::exp(-k_attenuation_below[band] * radius);
}

class BelowSurface : public testing::TestWithParam<RenderDesc::Integrator> {};

TEST_P(BelowSurface, ALampLightsTheWallAndTheWaterByItsImage) {
    const Point3 lamp{0.3, -0.4, 1};
    SceneDesc desc = lit_from(lamp);
    desc.render.integrator = GetParam();
    if (GetParam() == RenderDesc::Integrator::planes) desc.render.planes.count = 1000;
    const TestScene scene(desc);
    const Point3 image = mirror_image(lamp);
    for (const auto& [x, y] : {std::pair{12, 12}, {3, 15}, {20, 9}}) {
        const PixelResult pixel = scene.pixel(x, y);
        const Ray ray = *scene.assembled().camera->refracted_ray(x + 0.5, y + 0.5);
        const double end = k_far_wall / ray.direction.z;
        const Point3 on = ray.at(end);
        for (std::size_t b = 0; b < 3; ++b) {
            const double irradiance = light_on_wall(lamp, on, b) +
                                      fresnel_reflectance(on - image) * light_on_wall(image, on, b);
            EXPECT_NEAR(pixel.irradiance[b], irradiance, 1e-9 * irradiance);
            const auto scattered = [&](const Point3& from, double s) {
                const Vector3 way = ray.at(s) - from;
                const double radius = glm::length(way);
                const double reflectance = from.y < k_ceiling ? fresnel_reflectance(way) : 1;
                return reflectance * 5 / (radius * radius) * k_scattering_below[b] *
                       phase_below(-glm::dot(way, ray.direction) / radius) *
                       std::exp(-k_attenuation_below[b] * (radius + s));
            };
            double backscatter = 0;
            for (const Point3& from : {lamp, image})
                backscatter += AdaptiveQuadrature::integrate(
                    [&](double s) { return scattered(from, s); }, 0, end, 1e-10);
            // Reflectance has the slope of a square root where total reflection begins. Planes and
            // small steps are rules of low order.
            const double slack = GetParam() == RenderDesc::Integrator::volume ? 1e-4 : 5e-3;
            EXPECT_NEAR(pixel.backscatter[b], backscatter, slack * backscatter) << x << " " << y;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Integrators, BelowSurface,
                         testing::Values(RenderDesc::Integrator::volume,
                                         RenderDesc::Integrator::planes,
                                         RenderDesc::Integrator::reference));

// A box between the lamp and the surface hides the image alone; one below hides both.
TEST(WaterSurfaceLight, WhatHidesALampFromTheSurfaceHidesItsImage) {
    const Point3 lamp{0, 0.5, 1};
    SceneDesc desc = lit_from(lamp);
    const double whole = TestScene(desc).pixel(12, 10).irradiance[1];
    desc.geometry.push_back(box({-2, -0.3, -1}, {2, -0.2, 3.5}));
    const TestScene scene(desc);
    const PixelResult pixel = scene.pixel(12, 10);
    const Point3 on = pixel.hit.position;
    ASSERT_NEAR(on.z, k_far_wall, 1e-9);
    EXPECT_NEAR(pixel.irradiance[1], light_on_wall(lamp, on, 1), 1e-9 * whole);
    EXPECT_GT(whole, 1.01 * light_on_wall(lamp, on, 1));
}

// Looking up at 45 degrees and more from the vertical the surface shows the wall, mirrored.
TEST(WaterSurfaceLight, ShowsWhatIsBelowAsAMirror) {
    const Point3 lamp{0.3, 0.2, 2};
    SceneDesc desc = lit_from(lamp, 20);
    const RenderedFilm film(desc);
    const TestScene scene(desc);
    int seen = 0;
    for (int y = 0; y < 18; ++y) {
        for (int x = 0; x < 24; x += 3) {
            const Ray ray = *scene.assembled().camera->refracted_ray(x + 0.5, y + 0.5);
            const double s = k_ceiling / ray.direction.y, to_wall = k_far_wall / ray.direction.z;
            if (!(s > 0) || s > 0.9 * to_wall) continue;
            const Point3 on = mirror_image(ray.at(to_wall));
            for (std::size_t b = 0; b < 3; ++b) {
                const double c = k_attenuation_below[b];
                const Point3 image = mirror_image(lamp);
                const double lit = light_on_wall(lamp, on, b) +
                                   fresnel_reflectance(on - image) * light_on_wall(image, on, b);
                const double direct =
                    fresnel_reflectance(ray.direction) * 0.5 / pi * lit * std::exp(-c * to_wall);
                const auto scattered = [&](const Point3& from, double at) {
                    const Point3 point = at < s ? ray.at(at) : mirror_image(ray.at(at));
                    const Vector3 back =
                        at < s ? ray.direction
                               : Vector3(ray.direction.x, -ray.direction.y, ray.direction.z);
                    const Vector3 way = point - from;
                    const double radius = glm::length(way);
                    const double reflectance = from.y < k_ceiling ? fresnel_reflectance(way) : 1;
                    return reflectance * (at < s ? 1 : fresnel_reflectance(ray.direction)) * 5 /
                           (radius * radius) * k_scattering_below[b] *
                           phase_below(-glm::dot(way, back) / radius) *
                           std::exp(-c * (radius + at));
                };
                double backscatter = 0;
                for (const Point3& from : {lamp, image})
                    for (const auto& [begin, end] : {std::pair{0.0, s}, {s, to_wall}})
                        backscatter += AdaptiveQuadrature::integrate(
                            [&](double at) { return scattered(from, at); }, begin, end, 1e-9);
                EXPECT_NEAR(film.value(Layer::direct, x, y, static_cast<int>(b)), direct,
                            1e-5 * direct);
                EXPECT_NEAR(film.value(Layer::backscatter, x, y, static_cast<int>(b)), backscatter,
                            1e-3 * backscatter);
            }
            ++seen;
            EXPECT_NEAR(film.value(Layer::path, x, y, 0), s, 1e-5 * s);
        }
    }
    EXPECT_GT(seen, 30);
}

SceneDesc under_uniform_sky(double radiance) {
    SceneDesc desc = scene_below(90);
    LampDesc lamp;
    lamp.name = "sky";
    SkyDesc sky;
    sky.model = SkyDesc::Model::uniform;
    sky.irradiance = PerBand(3, pi * radiance);
    sky.samples = 256;
    sky.where = "test";
    lamp.sky = std::make_shared<const SkyDesc>(sky);
    lamp.direction = -desc.water.surface->normal;
    lamp.sun = SunDesc{.surface = *desc.water.surface};
    lamp.intensity = PerBand(3, 0.0);
    lamp.fixed_to_camera = false;
    desc.lamps = {lamp};
    return desc;
}

// In the window the sky is n^2 times as bright, less what is reflected; outside there is none.
TEST(WaterSurfaceLight, SkyIsSeenInSnellsWindow) {
    SceneDesc desc = under_uniform_sky(2);
    desc.geometry.clear();
    desc.camera.intrinsics.fx = desc.camera.intrinsics.fy = 6;  // 127 degrees wide
    const RenderedFilm film(desc);
    const TestScene scene(desc);
    int inside = 0, outside = 0;
    for (int y = 0; y < 18; ++y)
        for (int x = 0; x < 24; ++x) {
            const Ray ray = *scene.assembled().camera->refracted_ray(x + 0.5, y + 0.5);
            const double transmittance = 1 - fresnel_reflectance(ray.direction);
            const double s = k_ceiling / ray.direction.y;
            for (int b = 0; b < 3; ++b) {
                const double sky = 2 * k_water_index * k_water_index * transmittance *
                                   std::exp(-k_attenuation_below[static_cast<std::size_t>(b)] * s);
                EXPECT_NEAR(film.value(Layer::direct, x, y, b), sky, 1e-6);
            }
            ++(transmittance > 0 ? inside : outside);
        }
    EXPECT_GT(inside, 50);
    EXPECT_GT(outside, 50);
}

// Below the surface a uniform sky leaves the fraction 1 - R of its irradiance, R the diffuse
// reflectance from above: 2 int R(theta) cos sin dtheta.
TEST(WaterSurfaceLight, SkyLightsWhatLiesBelow) {
    SceneDesc desc = under_uniform_sky(2);
    desc.camera.world_from_camera = Affine::rotation_xyz_degrees({-90, 0, 0});
    desc.geometry = {plane({0, 2, 0}, {0, -1, 0})};
    desc.water.absorption = PerBand{0, 0, 0};
    desc.water.scattering->b = {0, 0, 0};
    const PixelResult pixel = TestScene(desc).pixel(12, 9);
    const double passed = AdaptiveQuadrature::integrate(
        [](double theta) {
            return theta > 0 ? 2 * std::sin(theta) * std::cos(theta) *
                                   fresnel_by_angles(theta, 1, k_water_index).mean()
                             : 0;
        },
        0, pi / 2 - 1e-9, 1e-10);
    for (std::size_t b = 0; b < 3; ++b)
        EXPECT_NEAR(pixel.irradiance[b], 2 * pi * passed, 1e-4 * 2 * pi * passed);  // Sky's own
}

// A sun in the air is refracted: irradiance on the floor is what is not reflected, times the cosine
// in the air.
TEST(WaterSurfaceLight, SunIsRefracted) {
    SceneDesc desc = scene_below(-90);
    desc.geometry = {plane({0, 2, 0}, {0, -1, 0})};
    LampDesc sun;
    sun.name = "sun";
    const double angle = 1.1;
    sun.direction = {std::sin(angle), std::cos(angle), 0};
    sun.sun = SunDesc{.surface = *desc.water.surface};
    sun.intensity = PerBand{1, 2, 3};
    sun.fixed_to_camera = false;
    desc.lamps = {sun};
    const PixelResult pixel = TestScene(desc).pixel(12, 9);
    const double in_water = std::sqrt(1 - std::pow(std::sin(angle) / k_water_index, 2));
    for (std::size_t b = 0; b < 3; ++b) {
        const double irradiance = static_cast<double>(b + 1) * std::cos(angle) *
                                  fresnel_by_angles(angle, 1, k_water_index).mean() *
                                  std::exp(-k_attenuation_below[b] * 3.2 / in_water);
        EXPECT_NEAR(pixel.irradiance[b], irradiance, 1e-9 * irradiance);
    }
}

// In water that absorbs nothing, over a white floor and under a uniform sky, light is in
// equilibrium: its radiance is n^2 that of the sky everywhere and in every direction. What leaves
// through the surface is exactly what enters, and what the surface reflects is needed for it.
TEST(WaterSurfaceLight, IsInEquilibriumWhereNothingIsAbsorbed) {
    SceneDesc desc = under_uniform_sky(2);
    desc.geometry = {plane({0, 0.5, 0}, {0, -1, 0})};
    desc.geometry[0].reflectance = PerBand(3, 1.0);
    desc.water.absorption = PerBand{0, 0, 0};
    desc.water.scattering->b = {0.2, 0.2, 0.2};
    desc.render.integrator = RenderDesc::Integrator::path;
    desc.render.samples = 1024;
    desc.camera.width = desc.camera.height = 2;
    double all = 0, variance_of_all = 0;
    for (const double tilt : {-90.0, -20.0, 35.0, 90.0}) {
        desc.camera.world_from_camera = Affine::rotation_xyz_degrees({tilt, 0, 0});
        const RenderedFilm film(desc);
        const double truth = 2 * k_water_index * k_water_index;
        double mean = 0, variance = 0;
        for (int i = 0; i < 4; ++i) {
            mean += 0.25 * film.value(Layer::total, i % 2, i / 2, 1);
            variance += std::pow(0.25 * film.value(Layer::error, i % 2, i / 2, 1), 2);
        }
        const double error = std::sqrt(variance);
        EXPECT_LT(error, 0.1 * truth) << tilt;
        EXPECT_NEAR(mean, truth, 3 * error) << tilt;
        all += 0.25 * mean;
        variance_of_all += variance / 16;
    }
    // All directions together, to a few per cent.
    EXPECT_LT(variance_of_all, std::pow(0.04 * 2 * k_water_index * k_water_index, 2));
    EXPECT_NEAR(all, 2 * k_water_index * k_water_index, 3 * std::sqrt(variance_of_all));
}

// Light from the air enters a trough below the level of calm water, and nothing shades what is
// below it: with the maps of what lamps see as without them.
TEST(WaterSurfaceLight, TroughsCastNoShadows) {
    SceneDesc desc = under_uniform_sky(2);
    desc.camera.world_from_camera = Affine::rotation_xyz_degrees({-5, 0, 0});
    desc.geometry = {plane_at_z(k_far_wall), box({-1, 0.5, 1.5}, {-0.5, 1, 2})};
    WavesDesc waves;
    waves.shape = std::vector<SineWaveDesc>{{.amplitude = 0.05, .wavelength = 2, .direction = 20}};
    desc.water.surface->waves = std::make_shared<const WavesDesc>(waves);
    SkyDesc sky = *desc.lamps[0].sky;
    sky.samples = 16;
    desc.lamps[0].sky = std::make_shared<const SkyDesc>(sky);
    LampDesc sun;
    sun.name = "sun";
    sun.direction = {0.6, 0.8, 0};
    sun.sun = SunDesc{.surface = *desc.water.surface};
    sun.intensity = PerBand{1, 2, 3};
    sun.fixed_to_camera = false;
    desc.lamps.push_back(sun);
    SceneDesc exact = desc;
    exact.render.integrator = RenderDesc::Integrator::reference;
    const TestScene by_maps(desc), by_rays(exact);
    for (const auto& [x, y] : {std::pair{12, 12}, {3, 15}, {20, 9}}) {
        const PixelResult found = by_maps.pixel(x, y), truth = by_rays.pixel(x, y);
        // Small steps are a rule of low order.
        for (std::size_t b = 0; b < 3; ++b)
            EXPECT_NEAR(found.backscatter[b], truth.backscatter[b], 5e-3 * truth.backscatter[b])
                << x << " " << y;
    }
}

// A lamp that is seen lights a surface whole, whatever its image adds.
TEST(WaterSurfaceLight, CountsAnImageForNoLampOfItsOwn) {
    const PixelResult pixel = TestScene(lit_from({0.3, -0.4, 1})).pixel(12, 12);
    EXPECT_EQ(pixel.lit, 1);
}

TEST(WaterSurfaceLight, RefusesWhatItsMirrorDoesNotShow) {
    const auto message_for = [](SceneDesc desc) {
        return message_of<InputError>([&] { RenderedFilm{desc}; });
    };
    SceneDesc desc = lit_from({0.3, 0.2, 2}, 20);
    desc.render.integrator = RenderDesc::Integrator::planes;
    EXPECT_NE(message_for(desc).find("render.integrator: planes with a water surface"),
              std::string::npos);
    desc = lit_from({0.3, 0.2, 2}, 20);
    desc.water.snow = SnowDesc{};
    desc.water.snow->number = 10;
    desc.water.snow->least = 1e-3;
    desc.water.snow->greatest = 2e-3;
    desc.water.snow->reflectance = PerBand(3, 0.4);
    EXPECT_NE(message_for(desc).find("water.snow with a water surface"), std::string::npos);
    // Down there is no mirror.
    desc.camera.world_from_camera = Affine::rotation_xyz_degrees({-60, 0, 0});
    EXPECT_GT(RenderedFilm(desc).sum(Layer::total, 1), 0);
}

TEST(WaterSurfaceLight, RefusesWhatIsInTheAir) {
    SceneDesc desc = lit_from({0, -2, 1});
    EXPECT_NE(message_of<InputError>([&] { TestScene{desc}; }).find("the lamp is 0.8 m above"),
              std::string::npos);
    desc = lit_from({0, 0, 1});
    desc.water.surface->point.y = 0.5;
    EXPECT_NE(message_of<InputError>([&] { TestScene{desc}; }).find("the camera is 0.5 m above"),
              std::string::npos);
}

}  // namespace
}  // namespace uw::test
