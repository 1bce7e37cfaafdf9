// ctest labels: analytic metamorphic
// Suns: what they light and what of it the water scatters, in closed form and by every integrator.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/light/surface_lighting.h"
#include "core/paths/path_tracer.h"
#include "tests/support/field_maker.h"
#include "tests/support/paths/ray_batches.h"
#include "tests/support/suns.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

using std::numbers::pi;

constexpr double k_wall = 4;
// The coefficients of hg_water.
constexpr std::array k_attenuation{0.55, 0.30, 0.30};
constexpr std::array k_scattering{0.20, 0.22, 0.25};
constexpr double k_g = 0.9;

/// Looks up a little, so that some rays leave the water before they meet the wall.
SceneDesc sunlit_scene(double angle = 0, int samples = 32) {
    SceneDesc desc = pinhole_scene(24, 18);
    desc.geometry = {plane_at_z(k_wall)};
    desc.water.surface = k_sea_level;
    desc.water.surface->point.y = -1.2;
    desc.lamps = {slanting_sun(angle, samples)};
    desc.lamps[0].sun->surface = *desc.water.surface;
    return desc;
}

SceneDesc with_shadows(double angle = 0, int samples = 32) {
    SceneDesc desc = sunlit_scene(angle, samples);
    desc.geometry.push_back(box({-0.4, -0.6, 1.5}, {0.2, -0.3, 2.2}));
    return desc;
}

double phase(double cosine) {
    return (1 - k_g * k_g) / (4 * pi * std::pow(1 + k_g * k_g - 2 * k_g * cosine, 1.5));
}

class Sun : public testing::TestWithParam<RenderDesc::Integrator> {};

TEST_P(Sun, LightsAWallAndTheWaterAsTheClosedFormSays) {
    SceneDesc desc = sunlit_scene();
    desc.render.integrator = GetParam();
    if (GetParam() == RenderDesc::Integrator::planes) desc.render.planes.count = 400;
    const TestScene scene(desc);
    const Sunlight sun{desc.lamps[0].direction, *desc.water.surface};
    int left = 0, rays = 0;
    for (int y = 0; y < 18; ++y)
        for (int x = 0; x < 24; x += 5) {
            const PixelResult pixel = scene.pixel(x, y);
            const Ray ray = *scene.assembled().camera->refracted_ray(x + 0.5, y + 0.5);
            const double to_wall = k_wall / ray.direction.z;
            const double begin = sun.length_to(ray.origin), slope = sun.slope(ray.direction);
            const double end = slope < 0 ? std::min(to_wall, -begin / slope) : to_wall;
            const double at_wall = sun.length_to(ray.at(to_wall));
            for (std::size_t b = 0; b < 3; ++b) {
                const double c = k_attenuation[b], irradiance = desc.lamps[0].intensity->at(b);
                const double rate = c * (1 + slope);
                const double backscatter = irradiance * k_scattering[b] *
                                           phase(-glm::dot(sun.direction, ray.direction)) *
                                           std::exp(-c * begin) * -std::expm1(-rate * end) / rate;
                // Planes and small steps cut the last one at the surface by its middle.
                const double slack = GetParam() == RenderDesc::Integrator::volume ? 2e-5 : 5e-3;
                EXPECT_NEAR(pixel.backscatter[b], backscatter, slack * backscatter);
                const double lit =
                    at_wall > 0 ? irradiance * sun.direction.z * std::exp(-c * at_wall) : 0;
                EXPECT_NEAR(pixel.irradiance[b], lit, 1e-9 * lit);
                const double direct = lit * 0.5 / pi * std::exp(-c * to_wall);
                EXPECT_NEAR(pixel.direct[b], direct, 1e-9 * direct);
            }
            left += end < to_wall ? 1 : 0;
            ++rays;
        }
    EXPECT_GT(left, 5);
    EXPECT_GT(rays - left, 20);
}

INSTANTIATE_TEST_SUITE_P(Integrators, Sun,
                         testing::Values(RenderDesc::Integrator::volume,
                                         RenderDesc::Integrator::planes,
                                         RenderDesc::Integrator::reference));

double rms_difference(const SceneDesc& desc, RenderDesc::Integrator truth) {
    const std::vector<PixelResult> image = TestScene(desc).image();
    SceneDesc slow = desc;
    slow.render.integrator = truth;
    const std::vector<PixelResult> expected = TestScene(slow).image();
    double squares = 0, sum = 0;
    for (std::size_t i = 0; i < image.size(); ++i) {
        EXPECT_NEAR(image[i].direct[1], expected[i].direct[1], 2e-3 * expected[i].direct[1]);
        squares += std::pow(image[i].backscatter[1] - expected[i].backscatter[1], 2);
        sum += expected[i].backscatter[1];
    }
    EXPECT_GT(sum, 0);
    const auto n = static_cast<double>(image.size());
    return std::sqrt(squares / n) / (sum / n);
}

// Shadows in the water, found in the maps, against rays and small steps, whose errors at edges are
// of first order: a step is 0.5 % of the length over which the light falls to 1/e.
TEST(Suns, ShadowsInTheWaterAgreeWithTheReference) {
    EXPECT_LT(rms_difference(with_shadows(), RenderDesc::Integrator::reference), 4e-3);
    EXPECT_LT(rms_difference(with_shadows(10, 8), RenderDesc::Integrator::reference), 4e-3);
}

// The columns of the map, two rays and steps per voxel, against exact ones.
TEST(Suns, APlumeAndItsShadowAgreeWithTheReference) {
    FieldMaker maker;
    VdbFixture fixture = bumpy_fixture();
    fixture.file_from_index = Affine::translation({-0.3, -0.5, 2}) * Affine::scale(Vector3(0.06));
    SceneDesc desc = with_shadows();
    desc.volumes = {maker.volume(fixture)};
    desc.volumes[0].grids[0].optics = GridMappingDesc::Optics{{0.1, 0.2, 0.3}, {0.4, 0.8, 1.2}, {}};
    EXPECT_LT(rms_difference(desc, RenderDesc::Integrator::reference), 4e-3);
}

TEST(Suns, ShadowsInTheWaterAgreeWithThePlanes) {
    SceneDesc desc = with_shadows();
    desc.render.planes.count = 2000;
    EXPECT_LT(rms_difference(desc, RenderDesc::Integrator::planes), 4e-3);
}

/// Whether the way back from `x` against `direction` crosses the box.
bool is_behind(const Bounds& box, const Point3& x, const Vector3& direction) {
    double begin = 0, end = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (x[axis] - box.min[axis]) / direction[axis];
        const double b = (x[axis] - box.max[axis]) / direction[axis];
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    return begin < end;
}

TEST(Suns, ABoxShadowsAFloorAsItsProjectionAlongTheLight) {
    const Bounds bounds{{-0.4, -0.6, 1.5}, {0.2, -0.3, 2.2}};
    SceneDesc desc = sunlit_scene();
    desc.geometry = {with_reflectance(plane({0, 1, 0}, {0, -1, 0}), 0.5, 3),
                     with_reflectance(box(bounds.min, bounds.max), 0.5, 3)};
    const TestScene scene(desc);
    const LitScene lit = scene.assembled().lit();
    int dark = 0, bright = 0;
    for (double x = -0.6; x < 1.6; x += 0.0613)
        for (double z = 1.2; z < 3.6; z += 0.0517) {
            SurfaceSample sample{{{x, 0.9, z}, {0, 1, 0}}, {}, 0, 0};
            ASSERT_TRUE(lit.surfaces->closest_hit(sample.ray, k_far, sample.hit));
            SurfaceLight light;
            DirectLighting(lit).evaluate_one(sample, light);
            const bool shadowed = is_behind(bounds, {x, 1, z}, desc.lamps[0].direction);
            EXPECT_EQ(light.visible(0, 0), !shadowed) << x << " " << z;
            (shadowed ? dark : bright) += 1;
        }
    EXPECT_GT(dark, 100);
    EXPECT_GT(bright, 100);
}

// A straight edge in front of a disc: the part of the disc beyond a chord.
TEST(Suns, PenumbraIsAsWideAsTheDisc) {
    constexpr double k_angle = 4, k_behind = 2;
    SceneDesc desc = pinhole_scene(4, 3);
    desc.water.absorption = {0, 0, 0};
    desc.water.scattering->b = {0, 0, 0};
    desc.water.surface = k_sea_level;
    desc.geometry = {with_reflectance(plane({0, 4, 0}, {0, -1, 0}), 0.5, 3),
                     box({-5, 4 - k_behind - 1e-3, -5}, {0, 4 - k_behind, 5})};
    desc.lamps = {slanting_sun(k_angle, 1024)};
    desc.lamps[0].direction = {0, 1, 0};
    const TestScene scene(desc);
    const LitScene lit = scene.assembled().lit();
    const double radius = k_behind * std::tan(glm::radians(0.5 * k_angle));
    for (double t = -1.25; t < 1.3; t += 0.25) {
        // Shadow rays begin at other places of each direction's part of the disc in every pixel.
        constexpr int k_pixels = 16;
        double irradiance = 0;
        for (int pixel = 0; pixel < k_pixels; ++pixel) {
            SurfaceSample sample{{{t * radius, 3.9, 0}, {0, 1, 0}}, {}, pixel + 0.5, 0.5};
            ASSERT_TRUE(lit.surfaces->closest_hit(sample.ray, k_far, sample.hit));
            SurfaceLight light;
            DirectLighting(lit).evaluate_one(sample, light);
            for (std::size_t j = 0; j < light.emitter_count(); ++j)
                if (light.visible(0, j)) irradiance += light.irradiance(0, j, 0) / k_pixels;
        }
        const double x = std::clamp(t, -1.0, 1.0);
        const double part = 1 - (std::acos(x) - x * std::sqrt(1 - x * x)) / pi;
        // 2.4/N at worst for a lattice of N points (lamp_extent.h).
        EXPECT_NEAR(irradiance, part, 2.4 / 1024 + 1e-3) << t;
    }
}

/// Uniform water under a sun straight above, in endless space, which scatters evenly.
PathScene evenly_scattering(const Vector3& direction, double g) {
    PathScene scene({{0.1, 0.2}}, g);
    Spectrum irradiance{};
    irradiance[0] = 2;
    const Lamp lamp("sun", Sunlight{glm::normalize(direction), k_sea_level}, irradiance);
    scene.lamps.push_back(lamp);
    return scene;
}

TEST(Suns, PathsHaveTheClosedFormOfLightScatteredOnce) {
    constexpr double c = 0.3, b = 0.2;
    for (const Vector3& look : {Vector3(0.1, 0.2, 1), Vector3(0.3, -1, 0.2), Vector3(-0.4, 1, 0)}) {
        const PathScene scene = evenly_scattering({0.5, 1, 0.3}, k_g);
        const Ray ray{{0.3, 1, 0.2}, glm::normalize(look)};
        const Sunlight& sun = *scene.lamps[0].sunlight();
        const auto batches = ray_batches(scene, ray, 1, 16);
        const BatchMeans once =
            means_of(batches, [&](const TermSums& sums) { return sums.order(0, 1); });
        const double begin = sun.length_to(ray.origin), slope = sun.slope(ray.direction);
        const double rate = c * (1 + slope), end = slope < 0 ? -begin / slope : 1e9;
        const double truth = 2 * b * phase(-glm::dot(sun.direction, ray.direction)) *
                             std::exp(-c * begin) * -std::expm1(-rate * end) / rate;
        // In uniform water of one band the density is the light itself: no noise.
        EXPECT_NEAR(once.mean(), truth, 1e-6 * truth);
    }
}

// With an even phase function, what is scattered twice to a level ray is the integral of the planes
// of equal light over the exponential integral of their depth.
TEST(Suns, PathsHaveTheQuadratureOfLightScatteredTwice) {
    constexpr double c = 0.3, b = 0.2, k_depth = 4;
    const PathScene scene = evenly_scattering({0, 1, 0}, 0);
    const Ray ray{{0, -3 + k_depth, 0}, {0, 0, 1}};
    const auto batches = ray_batches(scene, ray, 5, 32, 1 << 12);
    const BatchMeans twice =
        means_of(batches, [&](const TermSums& sums) { return sums.order(0, 2); });
    // int_0^z and int_z^inf of e^(-c z') E1(c |z - z'|), whose singularity is mild: substituted by
    // squares.
    const auto scattered = [&](double z) { return b * 2 * std::exp(-c * z) / (4 * pi); };
    const auto integral = [&](double length, double sign) {
        constexpr int k_steps = 20000;
        double sum = 0;
        for (int i = 0; i < k_steps; ++i) {
            const double t = (i + 0.5) / k_steps, away = length * t * t;
            sum += scattered(k_depth + sign * away) * -std::expint(-c * away) * 2 * length * t /
                   k_steps;
        }
        return sum;
    };
    const double fluence = 2 * pi * (integral(k_depth, -1) + integral(80, 1));
    const double truth = b * fluence / (4 * pi) / c;
    EXPECT_LT(twice.error(), 0.01 * truth);
    EXPECT_NEAR(twice.mean(), truth, 4 * twice.error());
}

}  // namespace
}  // namespace uw::test
