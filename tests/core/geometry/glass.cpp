// ctest labels: unit analytic
// Glass by its surfaces: a slab's offset, reflectance and absorption in closed form, panes, a ball
// as a lens, an air bubble, nested objects, and what surfaces of glass are for others.
#include "core/geometry/glass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "core/geometry/geometry_scene.h"
#include "tests/support/fresnel_by_angles.h"

namespace uw::test {
namespace {

constexpr double k_water = 1.334, k_glass = 1.52;
constexpr std::size_t k_bands = 3;

GeometryDesc box_of(const Point3& min, const Point3& max) {
    GeometryDesc box;
    box.type = GeometryDesc::Type::box;
    box.min = min;
    box.max = max;
    return box;
}

GeometryDesc ball_of(const Point3& center, double radius, double n) {
    GeometryDesc ball;
    ball.type = GeometryDesc::Type::sphere;
    ball.center = center;
    ball.radius = radius;
    ball.glass = GlassDesc{.n = n, .absorption = {}};
    return ball;
}

GeometryDesc pane_at(double z, GlassDesc glass) {
    GeometryDesc pane;
    pane.type = GeometryDesc::Type::plane;
    pane.point = {0, 0, z};
    pane.normal = {0, 0, -1};
    glass.is_thin = true;
    pane.glass = glass;
    return pane;
}

struct Scene {
    std::shared_ptr<const Surfaces> surfaces;
    std::shared_ptr<const GlassOptics> glass;
};

Scene scene_of(const std::vector<GeometryDesc>& geometry) {
    std::vector<std::string> warnings;
    Scene scene;
    scene.surfaces = build_surfaces(geometry, {620, 540, 450}, warnings);
    scene.glass = std::make_shared<GlassOptics>(scene.surfaces, k_water, k_bands, std::nullopt);
    return scene;
}

/// The ray after `count` surfaces, refracted at each, and what is left of the first band.
struct Passed {
    GlassRay ray;
    Spectrum left;
};
Passed pass(const Scene& scene, const Ray& ray, int count) {
    Passed passed{{ray, {}}, per_band(k_bands, [](std::size_t) { return 1.0; })};
    for (int i = 0; i < count; ++i) {
        SurfaceHit hit;
        EXPECT_TRUE(scene.surfaces->closest_hit(passed.ray.ray, 1e4, hit));
        EXPECT_NE(hit.glass, 0U);
        scene.glass->absorb(passed.ray.around, hit.distance, passed.left);
        const GlassSplit split = scene.glass->split(passed.ray, hit);
        passed.left *= split.transmittance;
        passed.ray = split.transmitted;
    }
    return passed;
}

TEST(Glass, SlabOffsetsAndDimsAsInClosedForm) {
    constexpr double k_thickness = 0.04;
    GeometryDesc slab = box_of({-9, -9, 1}, {9, 9, 1 + k_thickness});
    slab.glass = GlassDesc{.n = k_glass, .absorption = {0, 3, 20}};
    const Scene scene = scene_of({slab});
    for (const double angle : {1e-4, 0.4, 1.0, 1.3}) {
        SCOPED_TRACE(angle);
        const Vector3 direction(std::sin(angle), 0, std::cos(angle));
        const Passed passed = pass(scene, {{0, 0, 0}, direction}, 2);
        EXPECT_TRUE(passed.ray.around.empty());
        EXPECT_LT(glm::length(passed.ray.ray.direction - direction), 1e-12);
        const double inside = std::asin(k_water / k_glass * std::sin(angle));
        // Perpendicular to the ray. Rays begin 1e-6 m beside the surfaces that they leave.
        const double offset = k_thickness * std::sin(angle - inside) / std::cos(inside);
        const Vector3 aside(std::cos(angle), 0, -std::sin(angle));
        EXPECT_NEAR(glm::dot(passed.ray.ray.origin - Point3{0, 0, 0}, aside), -offset, 2e-6);
        const double face = fresnel_by_angles(angle, k_water, k_glass).mean();
        const double path = k_thickness / std::cos(inside);
        for (std::size_t b = 0; b < k_bands; ++b)
            EXPECT_NEAR(passed.left[b], face * face * std::exp(-slab.glass->absorption[b] * path),
                        1e-5);
    }
}

// Both faces and all reflections between them: T = (1 - R)/(1 + R) for each polarisation.
TEST(Glass, PaneTransmitsAndReflectsAsItsTwoFaces) {
    const Scene clear = scene_of({pane_at(1, {.n = k_glass, .absorption = {}})});
    const Scene dark =
        scene_of({pane_at(1, {.n = k_glass, .thickness = 0.01, .absorption = {5, 50, 500}})});
    for (const double angle : {1e-4, 0.7, 1.2, 1.5}) {
        SCOPED_TRACE(angle);
        const Ray ray{{0, 0, 0}, {std::sin(angle), 0, std::cos(angle)}};
        SurfaceHit hit;
        ASSERT_TRUE(clear.surfaces->closest_hit(ray, 1e4, hit));
        const GlassSplit split = clear.glass->split({ray, {}}, hit);
        const Polarised face = fresnel_by_angles(angle, k_water, k_glass);
        const auto through = [](double t) { return t / (2 - t); };
        EXPECT_TRUE(split.is_thin);
        EXPECT_EQ(split.transmitted.ray.direction, ray.direction);
        EXPECT_NEAR(split.transmittance[0], 0.5 * (through(face.s) + through(face.p)), 1e-12);
        EXPECT_NEAR(split.transmittance[0] + split.reflectance[0], 1, 1e-12);
        // A sum over the reflections, one by one.
        ASSERT_TRUE(dark.surfaces->closest_hit(ray, 1e4, hit));
        const GlassSplit dim = dark.glass->split({ray, {}}, hit);
        const double inside = std::asin(k_water / k_glass * std::sin(angle));
        const std::vector<double> absorption{5, 50, 500};
        for (std::size_t b = 0; b < k_bands; ++b) {
            const double left = std::exp(-absorption[b] * 0.01 / std::cos(inside));
            double transmitted = 0, reflected = 0;
            for (const double t : {face.s, face.p}) {
                const double r = 1 - t;
                reflected += 0.5 * r;
                double inner = t * left;
                for (int i = 0; i < 200; ++i) {
                    (i % 2 == 0 ? transmitted : reflected) += 0.5 * inner * t;
                    inner *= r * left;
                }
            }
            EXPECT_NEAR(dim.transmittance[b], transmitted, 1e-12);
            EXPECT_NEAR(dim.reflectance[b], reflected, 1e-12);
        }
        const Point3 behind = ray.at(2 / std::cos(angle));
        for (std::size_t b = 0; b < k_bands; ++b)
            EXPECT_NEAR(dark.glass->transmittance(ray.origin, behind)[b], dim.transmittance[b],
                        1e-12);
        EXPECT_NEAR(dark.glass->transmittance(behind, ray.origin, 1), dim.transmittance[1], 1e-12);
    }
}

/// Where a ray at this height that is parallel to the axis meets it behind a ball at the origin, by
/// angles alone: twice refracted, it turns by 2 (a - b).
double focus_of_ball(double height, double radius, double relative_index) {
    const double a = std::asin(height / radius), b = std::asin(height / radius / relative_index);
    const double turned = 2 * (a - b);
    // It leaves the ball at the angle 2 b - a beyond the axis.
    const double exit = 2 * b - a;
    return radius * std::cos(exit) + radius * std::sin(exit) / std::tan(turned);
}

TEST(Glass, BallFocusesAsALens) {
    constexpr double k_radius = 0.1, k_relative = k_glass / k_water;
    const Scene scene = scene_of({ball_of({0, 0, 0}, k_radius, k_glass)});
    for (const double height : {0.001, 0.01, 0.04, 0.07}) {
        SCOPED_TRACE(height);
        const Passed passed = pass(scene, {{height, 0, -1}, {0, 0, 1}}, 2);
        const Ray& ray = passed.ray.ray;
        const double z = ray.origin.z - ray.origin.x / ray.direction.x * ray.direction.z;
        EXPECT_NEAR(z, focus_of_ball(height, k_radius, k_relative), 1e-3 * k_radius);
    }
    // Near the axis: n r / (2 (n - 1)) from the centre.
    const Passed passed = pass(scene, {{0.001, 0, -1}, {0, 0, 1}}, 2);
    const Ray& ray = passed.ray.ray;
    const double z = ray.origin.z - ray.origin.x / ray.direction.x * ray.direction.z;
    EXPECT_NEAR(z, k_relative * k_radius / (2 * (k_relative - 1)), 1e-3 * z);
}

TEST(Glass, BubbleReflectsAllBeyondTheCriticalAngle) {
    const Scene scene = scene_of({ball_of({0, 0, 0}, 0.1, 1)});
    const double edge = 0.1 / k_water;  // sin of the critical angle
    const auto reflected = [&](double height) {
        const Ray ray{{height, 0, -1}, {0, 0, 1}};
        SurfaceHit hit;
        EXPECT_TRUE(scene.surfaces->closest_hit(ray, 1e4, hit));
        return scene.glass->split({ray, {}}, hit).reflectance[0];
    };
    EXPECT_EQ(reflected(1.0001 * edge), 1);
    EXPECT_LT(reflected(0.9999 * edge), 0.96);
    EXPECT_NEAR(reflected(0.05), 1 - fresnel_by_angles(std::asin(0.5), k_water, 1).mean(), 1e-9);
    EXPECT_EQ(scene.glass->transmittance({1.01 * edge, 0, -1}, {1.01 * edge, 0, 1}, 0), 0);
}

// An air bell in a shell of glass: the object that comes last takes the other's place.
TEST(Glass, LastOfNestedObjectsCounts) {
    const Scene scene = scene_of({ball_of({0, 0, 0}, 0.1, k_glass), ball_of({0, 0, 0}, 0.09, 1)});
    EXPECT_EQ(scene.glass->index(scene.glass->around({0, 0, 0.095})), k_glass);
    EXPECT_EQ(scene.glass->index(scene.glass->around({0, 0, 0.01})), 1);
    EXPECT_TRUE(scene.glass->around({0.099, 0.099, 0}).empty());
    const auto face = [](double from, double to) {
        return fresnel_by_angles(1e-4, from, to).mean();
    };
    const double once = face(k_water, k_glass) * face(k_glass, 1);
    EXPECT_NEAR(scene.glass->transmittance({0, 0, -1}, {0, 0, 1}, 0), once * once, 1e-9);
    EXPECT_NEAR(scene.glass->transmittance({0, 0, 0.01}, {0, 0, 1}, 0), once, 1e-9);
    // Overlapping: between the two surfaces of the first there is the second.
    const Scene apart =
        scene_of({ball_of({0, 0, 0}, 0.1, k_glass), ball_of({0, 0, 0.1}, 0.05, k_glass)});
    EXPECT_NEAR(apart.glass->transmittance({0, 0, -1}, {0, 0, 1}, 0),
                face(k_water, k_glass) * face(k_water, k_glass), 1e-9);
}

TEST(Glass, IsHitButCastsNoShadow) {
    GeometryDesc wall = box_of({-1, -1, 2}, {1, 1, 2.1});
    wall.reflectance = {0.3, 0.3, 0.3};
    const Scene scene = scene_of({wall, ball_of({0, 0, 1}, 0.2, k_glass)});
    SurfaceHit hit;
    ASSERT_TRUE(scene.surfaces->closest_hit({{0, 0, 0}, {0, 0, 1}}, 1e4, hit));
    EXPECT_EQ(hit.glass, 1U);
    EXPECT_EQ(hit.object_id, 2U);
    EXPECT_EQ(hit.reflectance[0], 0);
    EXPECT_NEAR(hit.distance, 0.8, 1e-9);
    EXPECT_FALSE(scene.surfaces->occluded({0, 0, 0}, {0, 0, 1.9}));
    EXPECT_TRUE(scene.surfaces->occluded({0, 0, 0}, {0, 0, 3}));
    EXPECT_NEAR(scene.surfaces->hit_distance({{0, 0, 0}, {0, 0, 1}}), 2, 1e-9);
    ASSERT_TRUE(scene.surfaces->closest_hit({{0.5, 0, 0}, {0, 0, 1}}, 1e4, hit));
    EXPECT_EQ(hit.glass, 0U);
    const std::vector<Ray> rays{{{0, 0, 0}, {0, 0, 1}}, {{0.5, 0, 0}, {0, 0, 1}}};
    std::vector<SurfaceHit> hits(2);
    std::vector<char> found(2);
    scene.surfaces->closest_hits(rays, 1e4, hits, found);
    EXPECT_EQ(hits[0].glass, 1U);
    EXPECT_EQ(hits[1].glass, 0U);
    EXPECT_EQ(hits[1].object_id, 1U);
}

}  // namespace
}  // namespace uw::test
