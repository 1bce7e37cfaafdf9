// ctest labels: analytic
// McGlamery's planes in uniform water: the midpoint rule by hand, and its convergence to the volume
// integrator, which shares no integration code with it.
#include "core/planes_integrator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

constexpr double k_plane_z = 4;

SceneDesc uniform_scene(const Point3& lamp) {
    SceneDesc desc = pinhole_scene(16, 12);
    desc.geometry = {plane_at_z(k_plane_z)};
    desc.lamps = {isotropic_lamp(lamp, 50)};
    return desc;
}

void use_kopelevich(SceneDesc& desc) {
    desc.water.scattering.reset();
    desc.water.small_ppm = 0.05;
    desc.water.large_ppm = 0.6;
}

SceneDesc with_planes(SceneDesc desc, int count, double near, double far) {
    desc.render.integrator = RenderDesc::Integrator::planes;
    desc.render.planes.count = count;
    desc.render.planes.near = near;
    desc.render.planes.far = far;
    return desc;
}

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
    // Lowest and highest order of convergence; 2 for the midpoint rule.
    double least_order = 1.9, greatest_order = 2.1;
};

struct Difference {
    double rms = 0, worst = 0;  // relative per pixel and band
};

// Between images of planes and volume, at the pixels that `wanted` marks.
Difference difference(const std::vector<PixelResult>& planes,
                      const std::vector<PixelResult>& volume, const std::vector<bool>& wanted) {
    Difference d;
    int count = 0;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        if (!wanted[i]) continue;
        for (std::size_t band = 0; band < 3; ++band) {
            const double relative = planes[i].backscatter[band] / volume[i].backscatter[band] - 1;
            d.worst = std::max(d.worst, std::abs(relative));
            d.rms += relative * relative;
            ++count;
        }
    }
    d.rms = std::sqrt(d.rms / count);
    return d;
}

class PlanesConverge : public ::testing::TestWithParam<Case> {};

TEST_P(PlanesConverge, ToTheVolumeIntegratorWithTheSquareOfTheThickness) {
    const std::vector<PixelResult> volume = TestScene(GetParam().desc).image();
    std::vector<std::vector<PixelResult>> planes;
    std::vector<Difference> differences;
    const std::vector<bool> all(volume.size(), true);
    for (const int count : {64, 128, 256, 512}) {
        planes.push_back(TestScene(with_planes(GetParam().desc, count, 0, 5)).image());
        differences.push_back(difference(planes.back(), volume, all));
        std::cout << "N " << count << ": max " << differences.back().worst << ", RMS "
                  << differences.back().rms;
        // Against the next one rather than the volume integrator: free of that one's own error.
        if (planes.size() > 2) {
            const std::size_t n = planes.size();
            const double before = difference(planes[n - 3], planes[n - 2], all).rms;
            const double after = difference(planes[n - 2], planes[n - 1], all).rms;
            const double order = std::log2(before / after);
            std::cout << ", order " << order;
            EXPECT_GE(order, GetParam().least_order);
            EXPECT_LE(order, GetParam().greatest_order);
        }
        std::cout << "\n";
    }
    EXPECT_LE(differences.back().worst, 1e-3);
}

SceneDesc ported(SceneDesc desc) {
    desc.camera.port =
        FlatPortDesc{glm::normalize(Vector3(0.05, -0.1, 1)), 0.02, 0.04, 1.0, 1.49, 1.334};
    desc.camera.world_from_camera =
        Affine::translation({0.3, 0.2, -0.1}) * Affine::rotation_xyz_degrees({3, -5, 10});
    return desc;
}

SceneDesc kopelevich(SceneDesc desc) {
    use_kopelevich(desc);
    return desc;
}

INSTANTIATE_TEST_SUITE_P(
    Lamps, PlanesConverge,
    ::testing::Values(Case{"beside_hg", uniform_scene({1, -0.5, 0})},
                      Case{"far_hg", uniform_scene({3, -2, 0.5})},
                      Case{"behind_hg", uniform_scene({0.4, -0.3, -1.5})},
                      Case{"close_hg", uniform_scene({0.3, 0, 0})},
                      Case{"port_hg", ported(uniform_scene({1, -0.5, 0}))},
                      Case{"beside_kopelevich", kopelevich(uniform_scene({1, -0.5, 0}))},
                      Case{"far_kopelevich", kopelevich(uniform_scene({3, -2, 0.5}))},
                      Case{"behind_kopelevich", kopelevich(uniform_scene({0.4, -0.3, -1.5}))},
                      Case{"port_kopelevich", ported(kopelevich(uniform_scene({1, -0.5, 0})))}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace uw::test
