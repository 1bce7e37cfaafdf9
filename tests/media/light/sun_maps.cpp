// ctest labels: analytic
// A sun's light splatted into a scene: shadows of a sphere and columns of a cloud in closed form.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "media/light/deep_shadow_map.h"
#include "media/light/light_projection.h"
#include "tests/support/column_errors.h"
#include "tests/support/gaussian_field.h"
#include "tests/support/random_direction.h"
#include "tests/support/sphere_surface.h"
#include "tests/support/suns.h"

namespace uw::test {
namespace {

const Sunlight k_sun{glm::normalize(Vector3(0.5, 1, 0.3)), k_sea_level};

bool contains(const std::vector<Interval>& intervals, double s) {
    for (const Interval& i : intervals)
        if (s >= i.begin && s <= i.end) return true;
    return false;
}

/// A floor of finite size under a sphere: two things in one.
class SphereOverAFloor : public SphereSurface {
  public:
    SphereOverAFloor(const Point3& center, double radius, double half)
        : SphereSurface(center, radius), half_(half) {}
    double hit_distance(const Ray& ray) const override {
        const double s = (4 - ray.origin.y) / ray.direction.y;
        const Point3 at = ray.at(s);
        const bool hits = s > 0 && std::abs(at.x) < half_ && std::abs(at.z) < half_;
        const double sphere = SphereSurface::hit_distance(ray);
        return hits ? std::min(s, sphere) : sphere;
    }
    bool occluded(const Point3& from, const Point3& to) const override {
        const double length = distance(from, to);
        return hit_distance({from, (to - from) / length}) < length * (1 - 1e-5);
    }
    Bounds bounds() const override {
        Bounds all = SphereSurface::bounds();
        all.extend(Point3{-half_, 4, -half_});
        all.extend(Point3{half_, 4, half_});
        return all;
    }

  private:
    double half_;
};

double disagreement(const Surfaces& surfaces, const Point3& centre, double reach,
                    std::size_t squares) {
    const std::vector<LightSquare> wanted =
        SunShadowMap::squares_around(centre, reach, surfaces.bounds(), k_sun);
    EXPECT_EQ(wanted.size(), squares);
    const SunShadowMap map(surfaces, k_sun, wanted, 256);
    EXPECT_EQ(map.rays_traced(), squares * 257 * 257);
    std::mt19937 rng(7);
    std::uniform_real_distribution<double> offset(-0.5, 0.5);
    std::vector<Interval> lit;
    double disagreeing = 0, shadowed = 0;
    for (int n = 0; n < 300; ++n) {
        // Rays through the shadow of the sphere.
        const Point3 origin{offset(rng), offset(rng), -1 + offset(rng)};
        const Point3 target = Point3{0.5, 0.3, 2} + (0.2 + offset(rng) + 0.5) * k_sun.direction +
                              0.4 * random_direction(rng);
        const Ray ray{origin, glm::normalize(target - origin)};
        const double end = std::min(6.0, surfaces.hit_distance(ray));
        map.lit_intervals(ray, {0, end}, lit);
        constexpr int k_samples = 2000;
        for (int i = 0; i < k_samples; ++i) {
            const Point3 x = ray.at(end * (i + 0.5) / k_samples);
            const bool truth = !surfaces.occluded(k_sun.entry(x), x);
            disagreeing +=
                truth != contains(lit, end * (i + 0.5) / k_samples) ? end / k_samples : 0;
            shadowed += truth ? 0 : end / k_samples;
        }
    }
    EXPECT_GT(shadowed, 50.0);  // metres: the test has something to find
    return disagreeing / shadowed;
}

TEST(SunShadowMap, LitIntervalsEndAtTheCylinderBehindASphere) {
    // Edges are bisected to 2e-4 m of 6 m; rays that graze the cylinder by less than a texel of
    // 3 mm are missed.
    EXPECT_LT(disagreement(SphereSurface({0.5, 0.3, 2}, 0.4), {}, 1e4, 1), 1e-3);
}

TEST(SunShadowMap, SquaresAroundTheCameraResolveASphereOverAWideFloor) {
    // One map of the floor of 4 km would have texels of 16 m. The smallest of four squares has
    // texels of 0.24 m, and the shadow of the sphere of 0.8 m is found but where a ray crosses it
    // on less than a texel.
    const SphereOverAFloor wide({0.5, 0.3, 2}, 0.4, 2000);
    EXPECT_LT(disagreement(wide, {}, 1e4, 4), 0.2);
    // Where the water lets see 60 m, texels are a few cm wide.
    EXPECT_LT(disagreement(wide, {}, 60, 3), 4e-3);
}

TEST(SunShadowMap, SquaresFollowTheCameraInSteps) {
    const Bounds wide{{-2000, 0, -2000}, {2000, 4, 2000}};
    const auto around = [&](double x) {
        return SunShadowMap::squares_around({x, 0, 0}, 60, wide, k_sun);
    };
    const std::vector<LightSquare> here = around(0);
    EXPECT_EQ(here, around(0.05));
    EXPECT_NE(here, around(100));
    for (const double x : {0.0, 13.0, -77.7}) {
        const std::vector<LightSquare> squares = around(x);
        const LightPoint camera = LightFrame(k_sun).point({x, 0, 0});
        for (std::size_t i = 0; i < squares.size(); ++i) {
            EXPECT_LE(std::abs(squares[i].u - camera.u), 0.2 * squares[i].half);
            EXPECT_LE(std::abs(squares[i].v - camera.v), 0.2 * squares[i].half);
            if (i > 0) {
                EXPECT_GT(squares[i].half, 3.9 * squares[i - 1].half);
            }
        }
    }
    EXPECT_TRUE(SunShadowMap::squares_around({}, 60, Bounds{}, k_sun).empty());
}

/// A thin roof of a given height over (x, z), infinite where there is none, under a vertical sun.
class Roof : public SphereSurface {
  public:
    using Height = double (*)(double x, double z);
    explicit Roof(Height height) : SphereSurface({}, 4), height_(height) {}
    double hit_distance(const Ray& ray) const override {
        const double s = height_(ray.origin.x, ray.origin.z) - ray.origin.y;
        return s > 0 ? s : std::numeric_limits<double>::infinity();
    }
    bool occluded(const Point3& from, const Point3& to) const override {
        const double height = height_(to.x, to.z);
        return height > from.y && height < to.y;
    }

  private:
    Height height_;
};

// Texels of 1 m, from -4 m to 4 m.
constexpr int k_roof_texels = 8;
const std::vector<LightSquare> k_roof_square{{0, 0, 4}};
const Sunlight k_noon{{0, 1, 0}, k_sea_level};

TEST(SunShadowMap, AShadowsEdgeInTheOutermostTexelsIsFound) {
    const Roof roof([](double x, double z) {
        return std::max(std::abs(x), std::abs(z)) < 3.5 ? 0
                                                        : std::numeric_limits<double>::infinity();
    });
    const SunShadowMap map(roof, k_noon, k_roof_square, k_roof_texels);
    for (const Vector3& outwards : {Vector3(1, 0, 0), {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}}) {
        const double edge = 3.5 - glm::dot(outwards, Vector3(0.2, 0, 0.3));
        const double end = edge + 0.4;  // before the last ray of the map
        std::vector<Interval> lit;
        map.lit_intervals({{0.2, 1, 0.3}, outwards}, {0, end}, lit);
        ASSERT_EQ(lit.size(), 1U);
        EXPECT_NEAR(lit[0].begin, edge, 3e-5 * end);
        EXPECT_EQ(lit[0].end, end);
    }
}

TEST(SunShadowMap, SurfacesMayRiseAQuarterTexelBetweenTheRaysOfTheMap) {
    // A ridge of 0.2 m along x between rays, which meet the roof at its feet.
    const Roof roof(
        [](double /*x*/, double z) { return -0.2 * std::max(0.0, 1 - std::abs(z + 0.5) / 0.5); });
    const SunShadowMap map(roof, k_noon, k_roof_square, k_roof_texels);
    // Along the ridge, and slowly down through it.
    const double length = std::hypot(6, 0.4);
    std::vector<Interval> lit;
    map.lit_intervals({{-3, -0.34, -0.5}, Vector3(6, 0.4, 0) / length}, {0, length}, lit);
    ASSERT_EQ(lit.size(), 1U);
    EXPECT_EQ(lit[0].begin, 0);
    EXPECT_NEAR(lit[0].end, 0.35 * length, 3e-5 * length);
}

TEST(SunColumnMap, MatchesTheClosedFormAndErrorFallsWithTheSquareOfTheVoxel) {
    const auto [error, peak] = column_errors(
        [&](const GaussianField& field) { return SunColumnMap(field, k_sun, 2, 1 << 28); },
        [&](const Point3& x) { return k_sun.entry(x); });
    // As ColumnMap's.
    EXPECT_LT(error[0], 3 * 0.08 * 0.08 / 8 / (0.3 * 0.3) * peak);
    EXPECT_LT(error[1], 0.35 * error[0]);
}

TEST(SunColumnMap, CountsAFieldBelowTheSurfaceOnly) {
    // The cloud's middle lies in the surface.
    const GaussianField field({0.2, -3, 2.5}, 0.3, 2.0, 0.03);
    const SunColumnMap map(field, k_sun, 2, 1 << 28);
    std::mt19937 rng(3);
    for (int n = 0; n < 1000; ++n) {
        Point3 x = Point3{0.2, -3, 2.5} + random_direction(rng);
        x.y = -3 + std::abs(x.y + 3);
        double truth = 0, found = 0;
        field.column(k_sun.entry(x), x, std::span<double>(&truth, 1));
        map.columns({&x, 1}, {&found, 1});
        // The field's edge at the surface is a kink: first order in the texel of 1.5 cm.
        EXPECT_NEAR(found, truth, 0.015 * 2.0);
    }
}

TEST(SunColumnMap, BreaksLieInTheCloudsShadow) {
    const GaussianField field({0.2, -0.1, 2.5}, 0.1, 2.0, 0.04);
    const SunColumnMap map(field, k_sun, 2, 1 << 28);
    const Ray ray{{1.2, 1.9, -400}, {0, 0, 1}};  // 2 m below the cloud
    std::vector<double> s;
    map.append_breaks(ray, {0, 800}, s);
    ASSERT_GT(s.size(), 10U);
    for (const double at : s) {
        // Around the shadow's middle, wider than the bounds of 6 sigma by the slant of the light.
        EXPECT_NEAR(at, 400 + 2.5 + 0.6, 1.5);
    }
}

}  // namespace
}  // namespace uw::test
