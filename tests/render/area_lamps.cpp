// ctest labels: analytic metamorphic
// Lamps with an extent: one lamp in every layer, the light of its points, soft shadows, and what is
// seen of the lamps themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <utility>
#include <vector>

#include "camera/camera.h"
#include "core/light/surface_lighting.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

using std::numbers::pi;

LampDesc panel(const LampExtentDesc& extent, const Point3& position, double intensity) {
    LampDesc lamp = isotropic_lamp(position, intensity);
    lamp.name = "panel";
    lamp.profile = CosineProfileDesc{120};
    lamp.extent = extent;
    return lamp;
}

LampExtentDesc disk(double radius, int samples) {
    return {LampExtentDesc::Shape::disk, 0, 0, 0, radius, samples};
}

/// A panel beside the camera and a point lamp, a box that shadows the water and a plane.
SceneDesc lit_by_a_panel(int samples) {
    SceneDesc desc = pinhole_scene(24, 18);
    desc.geometry = {plane_at_z(4), box({-0.1, -0.3, 1.0}, {0.2, 0.0, 1.3})};
    desc.lamps = {
        panel({LampExtentDesc::Shape::rectangle, 0.6, 0.2, 30, 0, samples}, {0.9, -0.5, 0}, 50),
        isotropic_lamp({-0.8, 0.1, 0.2}, 20)};
    return desc;
}

/// The same with each of the panel's points as a lamp of its own.
SceneDesc lit_by_its_points(int samples) {
    SceneDesc desc = lit_by_a_panel(samples);
    const TestScene scene(desc);
    const LampDesc whole = desc.lamps[0], other = desc.lamps[1];
    desc.lamps.clear();
    for (const Lamp& emitter : scene.assembled().emitters) {
        if (emitter.index() != 0) continue;
        LampDesc point = whole;
        point.name += std::to_string(desc.lamps.size());
        point.extent.reset();
        point.position = emitter.position();
        point.intensity = PerBand(3, 50.0 / samples);
        desc.lamps.push_back(point);
    }
    desc.lamps.push_back(other);
    return desc;
}

class AreaLamp : public testing::TestWithParam<RenderDesc::Integrator> {};

TEST_P(AreaLamp, IsOneLampWithTheLightOfItsPoints) {
    constexpr int k_samples = 5;
    SceneDesc whole = lit_by_a_panel(k_samples), parts = lit_by_its_points(k_samples);
    whole.render.integrator = parts.render.integrator = GetParam();
    // Coarser maps find the edges of shadows in the water from other texels on, to 3e-4 of their
    // distance.
    const double slack = GetParam() == RenderDesc::Integrator::volume ? 1e-3 : 1e-12;
    const std::vector<PixelResult> image = TestScene(whole).image();
    const std::vector<PixelResult> points = TestScene(parts).image();
    double direct = 0, backscatter = 0;
    for (std::size_t i = 0; i < image.size(); ++i) {
        ASSERT_EQ(image[i].lamps.size(), 2U);
        double lit = 0;
        for (std::size_t band = 0; band < 3; ++band) {
            double panel = 0;
            for (int j = 0; j < k_samples; ++j)
                panel += points[i].lamps[static_cast<std::size_t>(j)][band];
            EXPECT_NEAR(image[i].lamps[0][band], panel, slack * panel);
            EXPECT_NEAR(image[i].lamps[1][band], points[i].lamps[k_samples][band],
                        slack * points[i].lamps[k_samples][band]);
            EXPECT_NEAR(image[i].direct[band], points[i].direct[band],
                        1e-12 * points[i].direct[band]);
            EXPECT_NEAR(image[i].irradiance[band], points[i].irradiance[band],
                        1e-12 * points[i].irradiance[band]);
            EXPECT_NEAR(image[i].backscatter[band], points[i].backscatter[band],
                        slack * points[i].backscatter[band]);
            direct += image[i].direct[band];
            backscatter += image[i].backscatter[band];
            lit += image[i].lit;
        }
        EXPECT_GE(lit, 0);
        EXPECT_LE(image[i].lit, 1 + 1e-12);
    }
    EXPECT_GT(direct, 0);
    EXPECT_GT(backscatter, 0);
}

INSTANTIATE_TEST_SUITE_P(Integrators, AreaLamp,
                         testing::Values(RenderDesc::Integrator::volume,
                                         RenderDesc::Integrator::planes,
                                         RenderDesc::Integrator::reference));

// Shadows of a panel's points in the water, found in its maps, against rays and small steps.
TEST(AreaLamps, VolumeIntegratorAgreesWithTheReference) {
    SceneDesc desc = lit_by_a_panel(16);
    const std::vector<PixelResult> image = TestScene(desc).image();
    desc.render.integrator = RenderDesc::Integrator::reference;
    const std::vector<PixelResult> truth = TestScene(desc).image();
    double squares = 0, sum = 0;
    for (std::size_t i = 0; i < image.size(); ++i) {
        squares += std::pow(image[i].backscatter[1] - truth[i].backscatter[1], 2);
        sum += truth[i].backscatter[1];
    }
    const auto n = static_cast<double>(image.size());
    // As for point lamps: steps at shadow edges are the reference's, of first order.
    EXPECT_LT(std::sqrt(squares / n), 3e-3 * sum / n);
}

/// The light of one panel on the wall z = `wall` in front of it, without water.
class LightOnAWall {
  public:
    LightOnAWall(LampDesc lamp, double wall, std::vector<GeometryDesc> more = {})
        : scene_(make(std::move(lamp), wall, std::move(more))), wall_(wall) {}

    /// At a point of the wall.
    SurfaceLight at(double x, double y) const {
        const LitScene lit = scene_.assembled().lit();
        SurfaceSample sample{{{x, y, wall_ - 0.1}, {0, 0, 1}}, {}, 0, 0};
        EXPECT_TRUE(lit.surfaces->closest_hit(sample.ray, k_far, sample.hit));
        SurfaceLight light;
        DirectLighting(lit).evaluate_one(sample, light);
        return light;
    }

  private:
    static SceneDesc make(LampDesc lamp, double wall, std::vector<GeometryDesc> more) {
        SceneDesc desc = pinhole_scene(4, 3);
        desc.water.absorption = {0, 0, 0};
        desc.water.scattering->b = {0, 0, 0};
        desc.geometry = std::move(more);
        desc.geometry.push_back(plane_at_z(wall));
        desc.lamps = {std::move(lamp)};
        return desc;
    }

    TestScene scene_;
    double wall_;
};

// The penumbra of a half plane's edge, midway between a disk and a wall: of the disk, seen from the
// wall, the edge hides the part on one side of a line.
TEST(AreaLamps, TheShadowOfAnEdgeIsAsSoftAsTheDiskIsWide) {
    constexpr double k_radius = 0.4, k_edge = 0.6;
    constexpr int k_samples = 256;
    // The half plane x > 0.6, z = 2.
    const LightOnAWall wall(panel(disk(k_radius, k_samples), {k_edge, 0, 0}, 10), 4,
                            {box({k_edge, -50, 2}, {60, 50, 2 + 1e-4})});
    double squares = 0;
    int inside = 0;
    for (double x = -0.2; x < 1.4; x += 0.01) {
        const SurfaceLight light = wall.at(x, 0.1);
        double seen = 0;
        for (std::size_t j = 0; j < light.emitter_count(); ++j)
            if (light.visible(0, j)) seen += light.emitters()[j].share();
        // The line through the edge meets the disk's plane at 2 * 0.6 - x.
        const double t = std::clamp((k_edge - x) / k_radius, -1.0, 1.0);
        const double truth = 1 - (std::acos(t) - t * std::sqrt(1 - t * t)) / pi;
        EXPECT_NEAR(seen, truth, 4.0 / k_samples) << x;
        if (std::abs(t) == 1) continue;
        squares += (seen - truth) * (seen - truth);
        ++inside;
    }
    EXPECT_GE(inside, 78);
    EXPECT_LT(std::sqrt(squares / inside), 1.5 / k_samples);
}

// The share of what a diffuse point emits that falls on the square |x|, |y| < a at distance 1: the
// view factors of its four parts.
double share_on_square(double a, double x, double y) {
    double sum = 0;
    for (const double u : {a - x, a + x})
        for (const double v : {a - y, a + y}) {
            const double wide = std::sqrt(1 + u * u), high = std::sqrt(1 + v * v);
            sum += (u / wide * std::atan(v / wide) + v / high * std::atan(u / high)) / (2 * pi);
        }
    return sum;
}

TEST(AreaLamps, AllOfItsPowerArrives) {
    constexpr double k_radius = 0.3, k_half = 2, k_step = 0.05;
    LampDesc lamp = panel(disk(k_radius, 64), {0, 0, 0}, 0);
    lamp.intensity.reset();
    lamp.power = PerBand{1, 2, 3};
    const LightOnAWall wall(lamp, 1);
    Spectrum flux{};
    for (double y = -k_half + 0.5 * k_step; y < k_half; y += k_step)
        for (double x = -k_half + 0.5 * k_step; x < k_half; x += k_step) {
            const SurfaceLight light = wall.at(x, y);
            for (std::size_t j = 0; j < light.emitter_count(); ++j)
                for (std::size_t band = 0; band < 3; ++band)
                    flux[band] += light.irradiance(0, j, band) * k_step * k_step;
        }
    double share = 0;  // the mean over the disk
    constexpr int k_rings = 20, k_spokes = 16;
    for (int ring = 0; ring < k_rings; ++ring)
        for (int spoke = 0; spoke < k_spokes; ++spoke) {
            const double r = k_radius * std::sqrt((ring + 0.5) / k_rings);
            const double angle = 2 * pi * spoke / k_spokes;
            share +=
                share_on_square(2, r * std::cos(angle), r * std::sin(angle)) / (k_rings * k_spokes);
        }
    EXPECT_NEAR(share, 0.829, 1e-3);
    for (std::size_t band = 0; band < 3; ++band) {
        const auto power = static_cast<double>(band + 1);
        // Midpoints 5 cm apart, and 64 points.
        EXPECT_NEAR(flux[band], power * share, 5e-4 * power) << band;
    }
}

/// A lamp 3 m in front of the camera that faces it, of the radiance 10/A.
SceneDesc lamp_in_view(const LampDesc& lamp, int width = 24, int height = 18) {
    SceneDesc desc = pinhole_scene(width, height);
    desc.lamps = {lamp};
    desc.lamps[0].direction = {0, 0, -1};
    return desc;
}

/// The ray of a pixel's centre.
Ray center_ray(const TestScene& scene, int x, int y) {
    return scene.assembled().camera->refracted_ray(x + 0.5, y + 0.5).value();
}

class LampInView : public testing::TestWithParam<RenderDesc::Integrator> {};

// A Lambertian disk has the same radiance from wherever it is seen, I/A; water dims it by e^(-c s).
TEST_P(LampInView, IsADiskOfItsRadiance) {
    constexpr double k_radius = 0.6;
    SceneDesc desc = lamp_in_view(panel(disk(k_radius, 8), {0.2, 0.1, 3}, 10));
    desc.render.integrator = GetParam();
    desc.render.samples = 1;
    const TestScene scene(desc);
    const Medium& medium = scene.assembled().water.medium;
    int inside = 0;
    for (int y = 0; y < 18; ++y)
        for (int x = 0; x < 24; ++x) {
            const PixelResult pixel = scene.pixel(x, y);
            const Ray ray = center_ray(scene, x, y);
            const double s = 3 / ray.direction.z;
            const Point3 at = ray.at(s);
            const bool hits = std::hypot(at.x - 0.2, at.y - 0.1) < k_radius;
            inside += hits ? 1 : 0;
            for (std::size_t band = 0; band < 3; ++band) {
                const double truth = hits ? 10 / (pi * k_radius * k_radius) : 0;
                const double dimmed = truth * std::exp(-medium.uniform.attenuation(band) * s);
                EXPECT_NEAR(pixel.clean[band], truth, 1e-12 * truth) << x << " " << y;
                EXPECT_NEAR(pixel.direct[band], dimmed, 1e-12 * truth) << x << " " << y;
                EXPECT_EQ(pixel.lamps_in_view[band], pixel.direct[band]);
                EXPECT_NEAR(pixel.lamps[0][band], pixel.direct[band] + pixel.backscatter[band],
                            1e-12 * pixel.lamps[0][band]);
            }
        }
    EXPECT_GT(inside, 40);
}

INSTANTIATE_TEST_SUITE_P(Integrators, LampInView,
                         testing::Values(RenderDesc::Integrator::volume,
                                         RenderDesc::Integrator::planes,
                                         RenderDesc::Integrator::reference));

// The irradiance below the middle of a Lambertian disk, on a plane parallel to it, is pi L r^2 /
// (r^2 + d^2): the sum over the pixels of radiance, solid angle and cosine.
TEST(LampsInView, BringTheIrradianceOfALambertianDisk) {
    constexpr double k_radius = 0.5, k_distance = 2;
    SceneDesc desc = lamp_in_view(panel(disk(k_radius, 4), {0, 0, k_distance}, 10), 64, 48);
    desc.water.absorption = {0, 0, 0};
    desc.water.scattering->b = {0, 0, 0};
    desc.render.samples = 16;
    const TestScene scene(desc);
    const Vector3 a = center_ray(scene, 0, 0).direction, b = center_ray(scene, 1, 0).direction;
    const double pixel = b.x / b.z - a.x / a.z;  // on the plane z = 1
    double irradiance = 0;
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            const double cosine = center_ray(scene, x, y).direction.z;
            irradiance += scene.pixel(x, y).direct[1] * std::pow(cosine, 4) * pixel * pixel;
        }
    const double radiance = 10 / (pi * k_radius * k_radius);
    const double truth =
        pi * radiance * k_radius * k_radius / (k_radius * k_radius + k_distance * k_distance);
    EXPECT_NEAR(irradiance, truth, 3e-3 * truth);
}

TEST(LampsInView, HaveTheRadianceOfTheirProfile) {
    // Turned away by 60 degrees, a surface that shines in all directions alike is twice as bright.
    SceneDesc desc = pinhole_scene(3, 3);
    desc.water.absorption = {0, 0, 0};
    desc.water.scattering->b = {0, 0, 0};
    desc.render.samples = 1;
    desc.lamps = {panel({LampExtentDesc::Shape::rectangle, 2, 1, 0, 0, 4}, {0, 0, 3}, 10)};
    desc.lamps[0].profile = IsotropicProfileDesc{};
    desc.lamps[0].direction = {std::sqrt(0.75), 0, -0.5};
    EXPECT_NEAR(TestScene(desc).pixel(1, 1).direct[0], 10 / (2 * 0.5), 1e-9);
    // From behind as well, where a diffuse one is dark.
    desc.lamps[0].direction = {std::sqrt(0.75), 0, 0.5};
    EXPECT_NEAR(TestScene(desc).pixel(1, 1).direct[0], 10 / (2 * 0.5), 1e-9);
    desc.lamps[0].profile = CosineProfileDesc{120};
    EXPECT_EQ(TestScene(desc).pixel(1, 1).direct[0], 0);
    EXPECT_FALSE(TestScene(desc).pixel(1, 1).shows_lamp());
}

TEST(LampsInView, AreHiddenBySurfacesBeforeThemAlone) {
    SceneDesc desc = lamp_in_view(panel(disk(1, 4), {0, 0, 3}, 10));
    desc.render.samples = 4;
    // What is behind the lamp, or where it is fixed to, does not hide it.
    for (const double behind : {3.5, 3.0}) {
        desc.geometry = {plane_at_z(behind)};
        EXPECT_GT(TestScene(desc).pixel(12, 9).lamps_in_view[1], 0) << behind;
    }
    // A board hides the left half; the pixels at its edge see the lamp with half of their samples.
    desc.geometry = {box({-9, -9, 1}, {0, 9, 1.1})};
    const TestScene scene(desc);
    EXPECT_EQ(scene.pixel(11, 9).lamps_in_view[1], 0);
    EXPECT_GT(scene.pixel(12, 9).lamps_in_view[1], 0);
    desc.geometry = {box({-9, -9, 1}, {0.5 * (2.0 * std::tan(pi / 6) / 24), 9, 1.1})};
    const TestScene half(desc);
    EXPECT_NEAR(half.pixel(12, 9).lamps_in_view[1], 0.5 * scene.pixel(12, 9).lamps_in_view[1],
                0.01 * scene.pixel(12, 9).lamps_in_view[1]);
}

class PointsOfALampInView : public testing::TestWithParam<int> {};

// The pattern of points in the water is faint, and the fainter the more there are: as dots they
// would be many times as bright as the water between them. Against very many of them.
TEST_P(PointsOfALampInView, AreFaintInTheWater) {
    for (const bool is_disk : {true, false}) {
        const auto backscatter = [&](int samples) {
            const LampExtentDesc extent =
                is_disk
                    ? disk(0.5, samples)
                    : LampExtentDesc{LampExtentDesc::Shape::rectangle, 1.2, 0.5, 20, 0, samples};
            const TestScene scene(lamp_in_view(panel(extent, {0, 0, 3}, 10), 36, 27));
            std::vector<double> light;
            for (const PixelResult& pixel : scene.image()) light.push_back(pixel.backscatter[1]);
            return light;
        };
        const std::vector<double> few = backscatter(GetParam()), many = backscatter(700);
        double worst = 0, brightest = 0;
        for (std::size_t i = 0; i < few.size(); ++i) {
            worst = std::max(worst, std::abs(few[i] / many[i] - 1));
            brightest = std::max(brightest, many[i]);
        }
        std::cout << GetParam() << " points: worst " << 100 * worst << " %\n";
        EXPECT_GT(brightest, 3 * many[0]);
        EXPECT_LT(worst, 0.09);
    }
}

INSTANTIATE_TEST_SUITE_P(Numbers, PointsOfALampInView, testing::Values(32, 128));

// Rays that pass the points closely, where each integrator corrects what they scatter by itself.
TEST(LampsInView, AllIntegratorsAgreeInTheWaterAroundThem) {
    SceneDesc desc = lamp_in_view(panel(disk(0.4, 6), {0, 0, 2}, 10), 12, 9);
    desc.geometry = {plane_at_z(3)};
    const std::vector<PixelResult> image = TestScene(desc).image();
    desc.render.integrator = RenderDesc::Integrator::reference;
    const std::vector<PixelResult> truth = TestScene(desc).image();
    desc.render.integrator = RenderDesc::Integrator::planes;
    desc.render.planes.count = 2000;
    const std::vector<PixelResult> planes = TestScene(desc).image();
    for (std::size_t i = 0; i < image.size(); ++i) {
        EXPECT_NEAR(image[i].backscatter[1], truth[i].backscatter[1],
                    2e-3 * truth[i].backscatter[1]);
        EXPECT_NEAR(planes[i].backscatter[1], truth[i].backscatter[1],
                    2e-2 * truth[i].backscatter[1]);
    }
}

}  // namespace
}  // namespace uw::test
