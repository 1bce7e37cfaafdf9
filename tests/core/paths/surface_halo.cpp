// ctest labels: unit analytic
#include "core/paths/surface_halo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/sphere_surface.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

// Stripes on a sphere around the camera, which the water blurs equally everywhere: of 1 + cos(k
// azimuth) it scatters T(0) + T(k) cos(k azimuth), with the transfer function T at the sphere's
// distance.
double mean_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

// The slope of the line through (x, y), by least squares.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
    const double mean_x = mean_of(x), mean_y = mean_of(y);
    double xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    return xy / xx;
}

class HaloOfStripes : public testing::Test {
  protected:
    static constexpr int k_width = 240, k_height = 40;
    // A frequency of the table: a period of 11 degrees.
    static constexpr std::size_t k_frequency = 34;
    static constexpr double k_distance = 1.5;

    HaloOfStripes() {
        SceneDesc desc = pinhole_scene(k_width, k_height);
        const double focal = 0.5 * k_width / std::tan(glm::radians(40.0));
        desc.camera.intrinsics = {focal, focal, 0.5 * k_width, 0.5 * k_height};
        renderer_.set_scene(std::move(desc));
    }

    static double azimuth(const Vector3& direction) { return std::atan2(direction.x, direction.z); }

    Renderer renderer_;
    SphereSurface sphere_{{0, 0, 0}, k_distance};
};

TEST_F(HaloOfStripes, IsEquallyStrongAllOverTheImage) {
    const AssembledScene& assembled = renderer_.assemble();
    const RaySource& rays = *assembled.camera;
    LitScene scene = assembled.lit();
    scene.surfaces = &sphere_;
    const DirectLighting lighting(scene);
    const DistanceIntervals intervals(rays, scene);
    const auto bands = static_cast<std::size_t>(scene.medium->band_count());
    const double k = PointSpread::frequency(k_frequency);
    std::vector<SurfaceHalo::Position> nodes;
    // Beyond its edges an image is continued by its values there, which are not stripes.
    for (int x = k_width / 6; x < k_width - k_width / 6; ++x)
        nodes.push_back({x + 0.5, 0.5 * k_height});
    const auto stripes = [&](const SurfaceSample& sample, const SurfaceLight&, std::size_t,
                             std::span<double> radiance) {
        std::ranges::fill(radiance, 1 + std::cos(k * azimuth(sample.ray.direction)));
    };
    const SurfaceHalo halo(rays, scene, lighting, intervals, bands, k_width * k_height, stripes,
                           nodes);
    const PointSpread spread(*scene.medium, intervals, k_distance);
    ASSERT_EQ(halo.interval_count(), spread.interval_count());
    double of_stripes = 0;
    for (std::size_t interval = 0; interval < spread.interval_count(); ++interval) {
        of_stripes += static_cast<double>(
            spread.transfer(interval, 0, spread.distances().size() - 1)[k_frequency]);
    }
    // By parts of about a period, whose mean depends on what lies beyond the image, too.
    constexpr std::size_t k_periods = 5;
    for (std::size_t part = 0; part < k_periods; ++part) {
        std::vector<double> stripe, light;
        for (std::size_t n = part * nodes.size() / k_periods;
             n < (part + 1) * nodes.size() / k_periods; ++n) {
            const Vector3 direction = rays.refracted_ray(nodes[n].x, nodes[n].y)->direction;
            stripe.push_back(std::cos(k * azimuth(direction)));
            light.push_back(0);
            for (std::size_t i = 0; i < halo.interval_count(); ++i)
                light.back() += static_cast<double>(halo.of_node(n)[i * bands]);
        }
        // 8 %: at 27 degrees from the axis, as in the outermost parts, pixels are 6 % longer than
        // square ones of the same area, and the rest is the error of fitting the blur's levels.
        EXPECT_NEAR(slope(stripe, light), of_stripes, 0.08 * of_stripes) << part;
    }
}

}  // namespace
}  // namespace uw::test
