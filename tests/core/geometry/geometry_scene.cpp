// ctest labels: unit analytic
#include "core/geometry/geometry_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/geometry/surfaces.h"
#include "tests/support/geometry_descs.h"
#include "tests/support/surface_probes.h"

namespace uw {
namespace {

using test::box;
using test::build;
using test::plane;
using test::Random;
using test::seabed;
using test::sphere;

constexpr double k_far = 1e6;

TEST(Surfaces, SphereFollowsItsClosedForm) {
    const Point3 center{0.3, -0.2, 2};
    const double radius = 0.25;
    const auto surfaces = build({sphere(center, radius)});
    Random random;
    for (int k = 0; k < 2000; ++k) {
        const bool inside = k % 4 == 0;
        const Point3 origin = inside ? center + 0.2 * random.direction() : random.point(3);
        const Point3 target = center + random.uniform(0, 1.5) * radius * random.direction();
        const Ray ray{origin, glm::normalize(target - origin)};
        const Vector3 oc = origin - center;
        const double b = glm::dot(oc, ray.direction);
        const double disc = b * b - glm::dot(oc, oc) + radius * radius;
        if (std::abs(disc) < 1e-6) continue;  // tangents: any answer is right
        const double t0 = -b - std::sqrt(std::max(disc, 0.0)),
                     t1 = -b + std::sqrt(std::max(disc, 0.0));
        const bool expected = disc > 0 && t1 > 0;
        SurfaceHit hit;
        ASSERT_EQ(surfaces->closest_hit(ray, k_far, hit), expected) << k;
        if (!expected) continue;
        const double t = t0 > 0 ? t0 : t1;
        // Double arithmetic, amplified at most 1e3-fold by the discriminant's floor above.
        EXPECT_NEAR(hit.distance, t, 1e-10);
        const Vector3 outward = (hit.position - center) / radius;
        EXPECT_NEAR(glm::length(hit.normal - (t0 > 0 ? outward : -outward)), 0.0, 1e-9);
    }
}

TEST(Surfaces, SmallFarSphereKeepsItsPrecision) {
    // 1 mm at 1 km, where b^2 - c in single precision would be noise.
    const auto surfaces = build({sphere({0, 0, 1000}, 1e-3)});
    SurfaceHit hit;
    ASSERT_TRUE(surfaces->closest_hit({Point3{}, Vector3(0, 0, 1)}, k_far, hit));
    EXPECT_NEAR(hit.distance, 1000 - 1e-3, 1e-9);
}

TEST(Surfaces, BoxFollowsTheSlabTest) {
    const Point3 low{-0.5, -1, 1}, high{0.25, 0.75, 2.5};  // exact in single precision
    const auto surfaces = build({box(low, high)});
    Random random;
    int hits = 0;
    for (int k = 0; k < 3000; ++k) {
        const Ray ray{random.point(3), random.direction()};
        double enter = -k_far, leave = k_far;
        int enter_axis = 0, leave_axis = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (low[axis] - ray.origin[axis]) / ray.direction[axis];
            const double b = (high[axis] - ray.origin[axis]) / ray.direction[axis];
            if (std::min(a, b) > enter) enter = std::min(a, b), enter_axis = axis;
            if (std::max(a, b) < leave) leave = std::max(a, b), leave_axis = axis;
        }
        if (std::abs(leave - enter) < 1e-4) continue;  // along an edge
        const bool expected = enter < leave && leave > 0;
        SurfaceHit hit;
        ASSERT_EQ(surfaces->closest_hit(ray, k_far, hit), expected) << k;
        if (!expected) continue;
        ++hits;
        const double t = enter > 0 ? enter : leave;
        EXPECT_NEAR(hit.distance, t, 1e-12 * (1 + t / 1e-3));
        const int axis = enter > 0 ? enter_axis : leave_axis;
        Vector3 normal(0.0);
        normal[axis] = ray.direction[axis] > 0 ? -1 : 1;
        EXPECT_NEAR(glm::length(hit.normal - normal), 0.0, 1e-12);
    }
    EXPECT_GT(hits, 100);
}

TEST(Surfaces, PlanesAreInfiniteAndTwoSided) {
    const auto surfaces = build({plane({0, 0, 4}, {0, 0.3, -1})});
    const Vector3 n = glm::normalize(Vector3(0, 0.3, -1));
    SurfaceHit hit;
    const Ray ray{Point3{}, glm::normalize(Vector3(100, 1, 1))};
    ASSERT_TRUE(surfaces->closest_hit(ray, k_far, hit));
    const double t = glm::dot(Vector3(0, 0, 4), n) / glm::dot(ray.direction, n);
    EXPECT_NEAR(hit.distance, t, 1e-12 * t);
    EXPECT_NEAR(glm::length(hit.normal - n), 0.0, 1e-15);
    EXPECT_FALSE(surfaces->closest_hit(ray, 0.99 * t, hit));
    EXPECT_TRUE(surfaces->closest_hit({Point3{0, 0, 9}, Vector3(0, 0, -1)}, k_far, hit));
    EXPECT_NEAR(glm::length(hit.normal + n), 0.0, 1e-15);
    EXPECT_TRUE(std::isinf(surfaces->hit_distance({Point3{}, Vector3(0, 0, -1)})));
    EXPECT_TRUE(surfaces->occluded({0, 0, 0}, {0, 0, 8}));
    EXPECT_FALSE(surfaces->occluded({0, 0, 0}, {0, 0, 4}));
    EXPECT_TRUE(surfaces->bounds().empty());
    EXPECT_FALSE(surfaces->empty());
}

TEST(Surfaces, ShadowEndsAreExcludedAndNothingElse) {
    const auto surfaces = build({box({-1, -1, 2}, {1, 1, 3})});
    const double x = 0.125, y = 0.375;  // off the diagonals of the faces
    EXPECT_FALSE(surfaces->occluded({x, y, 0}, {x, y, 2}));
    EXPECT_FALSE(surfaces->occluded({x, y, 0}, {x, y, 2 + 1e-5}));
    EXPECT_TRUE(surfaces->occluded({x, y, 0}, {x, y, 2.0005}));
    EXPECT_TRUE(surfaces->occluded({x, y, 0}, {x, y, 3}));
    EXPECT_FALSE(surfaces->occluded({x, y, 2}, {x, y, 3}));
    EXPECT_FALSE(surfaces->occluded({x, y, 1}, {x, y, 1}));
    const auto ball = build({sphere({0, 0, 2}, 0.5)});
    EXPECT_FALSE(ball->occluded({0, 0, 0}, {0, 0, 1.5}));
    EXPECT_TRUE(ball->occluded({0, 0, 0}, {0, 0, 2}));
    EXPECT_TRUE(ball->occluded({0, 0, 0}, {0, 0, 2.5}));
    EXPECT_FALSE(ball->occluded({0, 0, 1.75}, {0, 0, 2.25}));
}

TEST(Surfaces, NumbersObjectsInSceneOrderAndGivesTheirReflectance) {
    GeometryDesc red = sphere({0, 3, 2}, 0.5);
    red.reflectance = PerBand{0.9, 0.1, 0.2};
    const auto surfaces =
        build({plane({0, 0, 9}, {0, 0, -1}), box({-4, -1, 1}, {-3, 1, 2}), red, seabed()});
    SurfaceHit hit;
    ASSERT_TRUE(surfaces->closest_hit({Point3{0, 3, 0}, Vector3(0, 0, 1)}, k_far, hit));
    EXPECT_EQ(hit.object_id, 3U);
    EXPECT_EQ(hit.reflectance[0], 0.9);
    EXPECT_EQ(hit.reflectance[2], 0.2);
    EXPECT_EQ(hit.reflectance[3], 0.0);
    ASSERT_TRUE(surfaces->closest_hit({Point3{0, 2, 0}, Vector3(0, 0, 1)}, k_far, hit));
    EXPECT_EQ(hit.object_id, 1U);
    EXPECT_EQ(hit.reflectance[1], 0.5);  // neither file nor scene says
    const Ray at_box{Point3{-3.4, 0.3, 0}, Vector3(0, 0, 1)};
    ASSERT_TRUE(surfaces->closest_hit(at_box, k_far, hit));
    EXPECT_EQ(hit.object_id, 2U);
    ASSERT_TRUE(surfaces->closest_hit({Point3{-5, 3, -5}, Vector3(0, -1, 0)}, k_far, hit));
    EXPECT_EQ(hit.object_id, 4U);
}

TEST(Surfaces, TransformedSphereIsAnEllipsoid) {
    GeometryDesc desc = sphere({0, 0, 0}, 1);
    desc.world_from_object = Affine::translation({0, 0, 10}) * Affine::scale({3, 2, -0.5});
    const auto surfaces = build({desc});
    const double x = 1.2, y = 0.8;
    SurfaceHit hit;
    ASSERT_TRUE(surfaces->closest_hit({Point3{x, y, 0}, Vector3(0, 0, 1)}, k_far, hit));
    const double z = -0.5 * std::sqrt(1 - x * x / 9 - y * y / 4);
    EXPECT_NEAR(hit.distance, 10 + z, 1e-12);
    const Vector3 normal = glm::normalize(Vector3(x / 9, y / 4, z / 0.25));
    EXPECT_NEAR(glm::length(hit.normal - normal), 0.0, 1e-12);
    EXPECT_NEAR(surfaces->bounds().max.x, 3, 1e-12);
    EXPECT_NEAR(surfaces->bounds().min.z, 9.5, 1e-12);
}

TEST(Surfaces, RefusesWhatCannotBeBuilt) {
    GeometryDesc flat = seabed();
    flat.where = "scene.yaml:3:5: geometry[0]";
    flat.world_from_object = Affine::scale({1, 0, 1});
    EXPECT_THROW(build({flat}), InputError);
    flat.world_from_object = Affine::scale({1e20, 1e20, 1e20});
    EXPECT_THROW(build({flat}), InputError);
    GeometryDesc two = box({0, 0, 0}, {1, 1, 1});
    two.reflectance = PerBand{0.5, 0.5};
    EXPECT_THROW(build({two}), InputError);
    const auto nothing = build({});
    EXPECT_TRUE(nothing->empty());
    EXPECT_FALSE(nothing->occluded({0, 0, 0}, {1, 1, 1}));
    EXPECT_TRUE(std::isinf(nothing->hit_distance({Point3{}, Vector3(0, 0, 1)})));
}

}  // namespace
}  // namespace uw
