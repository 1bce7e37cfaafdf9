// ctest labels: analytic unit
#include "core/paths/irradiance_cache.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace uw::test {
namespace {

SurfaceHit hit_at(const Point3& position, const Vector3& normal) {
    SurfaceHit hit;
    hit.position = position;
    hit.normal = hit.geometric_normal = normal;
    return hit;
}

/// Adds records scattered over a square of the plane z = `z`, with two values that are linear in x
/// and y.
void scatter_points(double z, double normal, double offset, std::vector<IrradianceRecord>& points,
                    std::vector<float>& radiance) {
    std::mt19937 rng(7);
    std::uniform_real_distribution<double> place(-1, 1);
    for (int i = 0; i < 2000; ++i) {
        const Point3 position{place(rng), place(rng), z};
        points.push_back({position, {0, 0, normal}});
        radiance.push_back(static_cast<float>(offset + 3 + position.x));
        radiance.push_back(static_cast<float>(offset + 5 - 2 * position.y));
    }
}

class IrradianceCaches : public testing::Test {
  protected:
    IrradianceCache light() const { return {points_, radiance_, 2}; }

    std::vector<IrradianceRecord> points_;
    std::vector<float> radiance_;
};

TEST_F(IrradianceCaches, AreLinearBetweenRecordsAndAtEdges) {
    scatter_points(0, 1, 0, points_, radiance_);
    const IrradianceCache found = light();
    std::array<double, 2> radiance{};
    for (const Point3& x : {Point3{0.13, -0.21, 0}, Point3{0.999, 0.4, 0}, Point3{-0.6, -1, 0}}) {
        found.find(hit_at(x, {0, 0, 1}), radiance);
        // Regularisation levels the plane a little: by up to 15 % of the change over the distance
        // between the eight nearest records, 0.1.
        EXPECT_NEAR(radiance[0], 3 + x.x, 0.015);
        EXPECT_NEAR(radiance[1], 5 - 2 * x.y, 0.03);
    }
}

TEST_F(IrradianceCaches, SeparateTheSidesOfAWall) {
    scatter_points(0, 1, 0, points_, radiance_);
    scatter_points(-0.001, -1, 100, points_, radiance_);
    const IrradianceCache found = light();
    std::array<double, 2> radiance{};
    found.find(hit_at({0.1, 0.2, 0}, {0, 0, 1}), radiance);
    EXPECT_NEAR(radiance[0], 3.1, 0.02);
    found.find(hit_at({0.1, 0.2, -0.001}, {0, 0, -1}), radiance);
    EXPECT_NEAR(radiance[0], 103.1, 0.02);
}

TEST_F(IrradianceCaches, AreDarkWithoutRecords) {
    std::array<double, 2> radiance{1, 1};
    light().find(hit_at({0, 0, 0}, {0, 0, 1}), radiance);
    EXPECT_EQ(radiance[0], 0);
    EXPECT_EQ(radiance[1], 0);
}

TEST_F(IrradianceCaches, CoverWhatIsNearAndFacesTheSameWay) {
    scatter_points(0, 1, 0, points_, radiance_);
    const IrradianceCache found = light();
    EXPECT_TRUE(found.covers(hit_at({0.5, 0.5, 0}, {0, 0, 1}), 0.1));
    EXPECT_FALSE(found.covers(hit_at({1.5, 0.5, 0}, {0, 0, 1}), 0.1));
    EXPECT_FALSE(found.covers(hit_at({0.5, 0.5, 0}, {0, 0, -1}), 0.1));
    EXPECT_FALSE(light().covers(hit_at({0.5, 0.5, 1}, {0, 0, 1}), 0.1));
}

}  // namespace
}  // namespace uw::test
