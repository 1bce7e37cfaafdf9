// ctest labels: analytic
#include "core/light/planes_integrator.h"

// McGlamery's planes in uniform water: the midpoint rule by hand, and its convergence to the volume
// integrator, which shares no integration code with it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/planes_scene.h"

namespace uw::test {
namespace {

// Henyey-Greenstein with g = 0.9, written again.
double hg(double cos_psi) {
    constexpr double g = 0.9;
    return (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cos_psi, 1.5));
}

// Equations 17 and 18 at one point of a ray from the origin, times the length of the slab's part.
double slab_by_hand(const Point3& x, const Point3& lamp, double length, std::size_t band) {
    const WaterDesc water = hg_water(0.9);
    const double b = water.scattering->b[band];
    const double c = (*water.absorption)[band] + b;
    const double to_camera = glm::length(from_origin(x)), radius = distance(x, lamp);
    const double cos_psi = glm::dot(x - lamp, -from_origin(x)) / (radius * to_camera);
    return 50 * std::exp(-c * (radius + to_camera)) / (radius * radius) * b * hg(cos_psi) * length;
}

// The ray of pixel (x, y) in camera axes, scaled to z = 1.
Vector3 pixel_ray(const SceneDesc& desc, int x, int y) {
    const IntrinsicsDesc& k = desc.camera.intrinsics;
    return {(x + 0.5 - k.cx) / k.fx, (y + 0.5 - k.cy) / k.fy, 1};
}

TEST(Planes, OneSlabIsTheClosedFormAtItsCentre) {
    const Point3 lamp(1, -0.5, 0);
    const SceneDesc desc = with_planes(uniform_scene(lamp), 1, 0.5, 3.5);
    const Vector3 ray = pixel_ray(desc, 3, 9);
    const PixelResult pixel = TestScene(desc).pixel(3, 9);
    for (std::size_t band = 0; band < 3; ++band) {
        // Centre z = 2; 3 m / cos(theta) = 3 |ray| with the ray's z = 1.
        const double truth =
            slab_by_hand(at_origin_plus(2.0 * ray), lamp, 3 * glm::length(ray), band);
        EXPECT_NEAR(pixel.backscatter[band], truth, 1e-12 * truth);
        EXPECT_NEAR(pixel.backscatter_first[band], truth, 1e-12 * truth);
        EXPECT_NEAR(pixel.lamps[0][band], truth + pixel.direct[band], 1e-12 * truth);
    }
}

TEST(Planes, SlabCutByTheSurfaceCountsWithItsPartInFront) {
    const Point3 lamp(1, -0.5, 0);
    // Slabs 0.5..3 and 3..5.5; the plane z = 4 leaves 3..4 of the second.
    const SceneDesc desc = with_planes(uniform_scene(lamp), 2, 0.5, 5.5);
    const Vector3 ray = pixel_ray(desc, 12, 2);
    const PixelResult pixel = TestScene(desc).pixel(12, 2);
    for (std::size_t band = 0; band < 3; ++band) {
        const double first =
            slab_by_hand(at_origin_plus(1.75 * ray), lamp, 2.5 * glm::length(ray), band);
        const double second =
            slab_by_hand(at_origin_plus(3.5 * ray), lamp, 1.0 * glm::length(ray), band);
        EXPECT_NEAR(pixel.backscatter[band], first + second, 1e-12 * (first + second));
        EXPECT_NEAR(pixel.backscatter_first[band], first, 1e-12 * first);
    }
}

TEST(Planes, SlabCutByTheGlassCountsWithItsPartInTheWater) {
    const Point3 lamp(1, -0.5, 0);
    SceneDesc desc = with_planes(uniform_scene(lamp), 1, 0, 3);
    desc.camera.port = FlatPortDesc{{0, 0, 1}, 0.5, 0.5, 1.0, 1.0, 1.0};  // bends nothing
    const Vector3 ray = pixel_ray(desc, 5, 5);
    const PixelResult pixel = TestScene(desc).pixel(5, 5);
    const WaterDesc water = hg_water(0.9);
    for (std::size_t band = 0; band < 3; ++band) {
        // The water begins at z = 1, and only from there it attenuates.
        const double c = (*water.absorption)[band] + water.scattering->b[band];
        const double truth =
            slab_by_hand(at_origin_plus(2.0 * ray), lamp, 2 * glm::length(ray), band) *
            std::exp(c * glm::length(ray));
        EXPECT_NEAR(pixel.backscatter[band], truth, 1e-12 * truth);
    }
}

// What the ends of one ray get does not depend on which others are asked for.
TEST(Planes, EveryEndGetsTheWaterBeforeIt) {
    const SceneDesc desc = with_planes(uniform_scene({1, -0.5, 0}), 7, 0.3, 3.8);
    const TestScene scene(desc);
    const Ray ray{{0, 0, 0}, glm::normalize(Vector3(0.2, -0.1, 1))};
    const std::vector<double> ends{0.1, 0.9, 0.95, 2.0, 3.0, 3.05, 3.1, 9};
    InScatter together, alone;
    scene.integrator().in_scatter(ray, ends, together);
    double previous = -1;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        scene.integrator().in_scatter(ray, std::span(ends).subspan(i, 1), alone);
        EXPECT_NEAR(together.at(i, 0)[1], alone.at(0, 0)[1], 1e-14 * alone.at(0, 0)[1]) << i;
        EXPECT_GT(together.at(i, 0)[1], i == 0 ? -1 : previous) << i;
        previous = together.at(i, 0)[1];
    }
    EXPECT_EQ(together.at(0, 0)[1], 0);  // before the first slab
}

struct Case {
    std::string name;
    SceneDesc desc;
    bool smooth = true;  // the phase function
    int finest = 512;    // number of slabs over 5 m
    bool spot = false;
};

class PlanesConverge : public ::testing::TestWithParam<Case> {};

TEST_P(PlanesConverge, ToTheVolumeIntegratorWithTheSquareOfTheThickness) {
    const Case& c = GetParam();
    const std::vector<PixelResult> volume = TestScene(c.desc).image();
    std::vector<std::vector<PixelResult>> planes;
    std::vector<Difference> differences;
    for (const int part : {8, 4, 2, 1}) {
        const int count = c.finest / part;
        planes.push_back(TestScene(with_planes(c.desc, count, 0, 5)).image());
        differences.push_back(difference(planes.back(), volume));
        std::cout << "N " << count << ": max " << differences.back().worst << ", RMS "
                  << differences.back().rms;
        if (planes.size() > 1)
            std::cout << ", order "
                      << std::log2(differences[planes.size() - 2].rms / differences.back().rms);
        std::cout << "\n";
    }
    // Mean order over three doublings. Corners of tabulated phase functions and slabs cut by the
    // surface fall at other places of the slabs with every N, so that single steps scatter about 2.
    if (!c.spot) {
        EXPECT_NEAR(std::log2(differences[0].rms / differences[3].rms) / 3, 2, 0.1);
    }
    // Between images of planes alone, free of the volume integrator's own error: about 1e-6, and up
    // to 2e-4 where a ray passes a spot's soft edge.
    const double before = difference(planes[1], planes[2]).rms;
    const double after = difference(planes[2], planes[3]).rms;
    std::cout << "order of the planes alone " << std::log2(before / after) << "\n";
    if (c.smooth) {
        EXPECT_NEAR(std::log2(before / after), 2, 0.1);
    }
    EXPECT_LE(differences.back().worst, 1e-3);  // the project's bound
}

// The second a spot whose soft edge crosses the view.
SceneDesc two_lamps() {
    SceneDesc desc = uniform_scene({1, -0.5, 0});
    desc.lamps.push_back(isotropic_lamp({-1.2, 0.3, 0.4}, 80));
    desc.lamps[1].name = "spot";
    desc.lamps[1].direction = glm::normalize(Vector3(0.8, -0.2, 1));
    desc.lamps[1].profile = SpotProfileDesc{60, 30};
    return desc;
}

INSTANTIATE_TEST_SUITE_P(
    Lamps, PlanesConverge,
    ::testing::Values(
        Case{"beside_hg", uniform_scene({1, -0.5, 0})}, Case{"far_hg", uniform_scene({3, -2, 0.5})},
        Case{"behind_hg", uniform_scene({0.4, -0.3, -1.5})},
        Case{"in_view_hg", uniform_scene({0.31, 0.22, 2})},
        Case{"port_hg", ported(uniform_scene({1, -0.5, 0}))},
        Case{"spot_hg", two_lamps(), true, 512, true},
        Case{"beside_kopelevich", kopelevich(uniform_scene({1, -0.5, 0})), false},
        Case{"far_kopelevich", kopelevich(uniform_scene({3, -2, 0.5})), false},
        Case{"behind_kopelevich", kopelevich(uniform_scene({0.4, -0.3, -1.5})), false},
        Case{"port_kopelevich", ported(kopelevich(uniform_scene({1, -0.5, 0}))), false},
        // The nearer the lamp, the thinner the slabs: about 1/12 of its distance.
        Case{"at_30_cm_hg", uniform_scene({0.3, 0, 0})},
        Case{"at_30_cm_kopelevich", kopelevich(uniform_scene({0.3, 0, 0})), false},
        Case{"at_10_cm_hg", uniform_scene({0.1, 0, 0}), true, 1024},
        Case{"at_3_cm_hg", uniform_scene({0.03, 0, 0}), true, 2048}),
    [](const auto& test) { return test.param.name; });

// Whether the lamp lights some points of the pixel's water ray and others not, looked at 20 times
// as finely as the slabs.
bool has_shadow_edge(const TestScene& scene, int x, int y) {
    const AssembledScene& parts = scene.assembled();
    const std::optional<Ray> ray = parts.camera->refracted_ray(x + 0.5, y + 0.5);
    const double end = parts.surfaces->hit_distance(*ray);
    constexpr int k_points = 10000;
    int dark = 0;
    for (int i = 0; i < k_points; ++i)
        dark +=
            parts.surfaces->occluded(parts.lamps[0].position(), ray->at(end * (i + 0.5) / k_points))
                ? 1
                : 0;
    return dark != 0 && dark != k_points;
}

struct ShadowDifference {
    int lit = 0, dark = 0, edges = 0;  // pixels
    double worst_lit = 0, worst_at_edges = 0;
};

ShadowDifference shadow_difference(const SceneDesc& desc) {
    const TestScene volume(desc);
    const TestScene planes(with_planes(desc, 512, 0, 5));
    ShadowDifference d;
    for (int y = 0; y < desc.camera.height; ++y) {
        for (int x = 0; x < desc.camera.width; ++x) {
            const Spectrum p = planes.pixel(x, y).backscatter, v = volume.pixel(x, y).backscatter;
            if (v[1] == 0) {
                EXPECT_EQ(p[1], 0);
                ++d.dark;
                continue;
            }
            const bool edge = has_shadow_edge(volume, x, y);
            double& worst = edge ? d.worst_at_edges : d.worst_lit;
            for (std::size_t band = 0; band < 3; ++band)
                worst = std::max(worst, std::abs(p[band] / v[band] - 1));
            ++(edge ? d.edges : d.lit);
        }
    }
    std::cout << d.lit << " pixels lit, max " << d.worst_lit << "; " << d.dark << " dark; "
              << d.edges << " with shadow edges, max " << d.worst_at_edges << "\n";
    return d;
}

TEST(PlanesShadows, AgreeWithTheVolumeIntegratorAwayFromTheEdges) {
    SceneDesc desc = ported(uniform_scene({1, -0.5, 0}));
    desc.geometry.push_back(box({0.3, -0.2, 1.5}, {0.6, 0.1, 1.8}));
    const ShadowDifference d = shadow_difference(desc);
    EXPECT_GT(d.lit, 50);
    EXPECT_GT(d.edges, 20);
    EXPECT_LT(d.worst_lit, 1e-3);
    // Each edge is off by up to half a slab, 5 mm of a ray of 4 m.
    EXPECT_LT(d.worst_at_edges, 1e-2);
}

TEST(PlanesShadows, AreDarkWhereNoLightComes) {
    SceneDesc desc = uniform_scene({1, -0.5, 0});
    desc.geometry.push_back(box({0.75, -3, -0.5}, {0.8, 3, 1.2}));  // between lamp and camera
    const ShadowDifference d = shadow_difference(desc);
    EXPECT_EQ(d.lit, 0);
    EXPECT_GT(d.dark, 50);
    EXPECT_GT(d.edges, 20);
}

}  // namespace
}  // namespace uw::test
