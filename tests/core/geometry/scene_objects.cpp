// ctest labels: unit analytic
#include "core/geometry/scene_objects.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/random_direction.h"

namespace uw {
namespace {

using test::random_direction;

MeshObject one_triangle() {
    MeshObject object;
    object.mesh.positions = {1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 0};
    object.mesh.triangles = {0, 1, 2};
    object.object_id = 5;
    return object;
}

SphereObject stretched_sphere() {
    SphereObject sphere;
    sphere.world_from_object = Affine::translation({1, 2, 3}) *
                               Affine::rotation_xyz_degrees({20, 30, 40}) *
                               Affine::scale({1, 2, 0.5});
    sphere.object_from_world = sphere.world_from_object.inverse();
    sphere.center = {0.1, -0.2, 0.3};
    sphere.radius = 0.7;
    sphere.object_id = 9;
    sphere.reflectance[0] = 0.4;
    return sphere;
}

TEST(SceneObjects, LinesCrossATriangleWhereItsCornersSay) {
    const MeshObject object = one_triangle();
    const Point3 a = object.corner(0, 0), b = object.corner(0, 1), c = object.corner(0, 2);
    std::mt19937 rng(1);
    std::uniform_real_distribution<double> uniform(0.01, 0.98);
    for (int n = 0; n < 500; ++n) {
        const double u = uniform(rng), v = (1 - u) * uniform(rng);
        const Point3 target = a + u * (b - a) + v * (c - a);
        const Vector3 direction = random_direction(rng);
        // Directions in the triangle's own plane have no crossing to speak of.
        if (std::abs(glm::dot(direction, glm::normalize(Vector3(6, 3, 2)))) < 0.05) continue;
        const Point3 origin = target - 4.0 * direction;
        const auto crossing = cross_triangle(object, 0, origin, 2.0 * direction);
        ASSERT_TRUE(crossing);
        EXPECT_NEAR(crossing->t, 2, 1e-12);  // in lengths of the direction
        EXPECT_NEAR(crossing->u, u, 1e-12);
        EXPECT_NEAR(crossing->v, v, 1e-12);
        EXPECT_EQ(crossing->well_inside(), u > 1e-3 && v > 1e-3 && u + v < 1 - 1e-3);
    }
}

TEST(SceneObjects, LinesMissATriangleBesideIt) {
    const MeshObject object = one_triangle();
    EXPECT_FALSE(cross_triangle(object, 0, {5, 5, 5}, {0, 0, 1}));
    EXPECT_FALSE(cross_triangle(object, 0, {1, 0, 0}, {-1, 2, 0}));  // along an edge
    const Point3 beyond{0.51, -0.02, 1.5};  // in its plane, past the edge from a to c
    EXPECT_FALSE(cross_triangle(object, 0, beyond - Vector3(6, 3, 2), {6, 3, 2}));
}

TEST(SceneObjects, LinesCrossAnEllipsoidOnItsSurface) {
    const SphereObject sphere = stretched_sphere();
    std::mt19937 rng(2);
    int crossed = 0;
    for (int n = 0; n < 500; ++n) {
        const Point3 origin = Point3{1, 2, 3} + 5.0 * random_direction(rng);
        const Point3 target = Point3{1, 2, 3} + random_direction(rng);
        const Vector3 direction = 0.3 * (target - origin);
        const auto crossings = cross_sphere(sphere, origin, direction);
        if (!crossings) continue;
        ++crossed;
        EXPECT_LE(crossings->near, crossings->far);
        for (const double t : {crossings->near, crossings->far}) {
            const Point3 at = sphere.object_from_world * (origin + t * direction);
            EXPECT_NEAR(distance(at, sphere.center), sphere.radius, 1e-10);
        }
    }
    EXPECT_GT(crossed, 50);
}

TEST(SceneObjects, FarSpheresKeepTheirDigits) {
    // A sphere of a millimetre a hundred kilometres away, and just beside it.
    SphereObject sphere;
    sphere.center = {0, 0, 1e5};
    sphere.radius = 1e-3;
    const auto crossings = cross_sphere(sphere, {0, 0.6e-3, 0}, {0, 0, 1});
    ASSERT_TRUE(crossings);
    EXPECT_NEAR(crossings->far - crossings->near, 1.6e-3, 1e-9);
    EXPECT_FALSE(cross_sphere(sphere, {0, 1.001e-3, 0}, {0, 0, 1}));
}

TEST(SceneObjects, BoundsOfAnEllipsoidTouchIt) {
    const SphereObject sphere = stretched_sphere();
    const Bounds bounds = sphere.world_bounds();
    Bounds sampled;
    std::mt19937 rng(3);
    for (int n = 0; n < 20000; ++n)
        sampled.extend(sphere.world_from_object *
                       (sphere.center + sphere.radius * random_direction(rng)));
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(bounds.min[axis], sampled.min[axis]);
        EXPECT_GE(bounds.max[axis], sampled.max[axis]);
        EXPECT_NEAR(bounds.min[axis], sampled.min[axis], 5e-3);
        EXPECT_NEAR(bounds.max[axis], sampled.max[axis], 5e-3);
    }
}

TEST(SceneObjects, NormalsStandAcrossTheSurfaceTowardsTheViewer) {
    const SphereObject sphere = stretched_sphere();
    std::mt19937 rng(4);
    for (int n = 0; n < 200; ++n) {
        const Vector3 out = random_direction(rng), view = random_direction(rng);
        const auto point = [&](const Vector3& direction) {
            return sphere.world_from_object *
                   (sphere.center + sphere.radius * glm::normalize(direction));
        };
        SurfaceHit hit;
        hit.position = point(out);
        shade_sphere(sphere, view, hit);
        EXPECT_NEAR(glm::length(hit.normal), 1, 1e-14);
        EXPECT_LE(glm::dot(hit.normal, view), 0);
        // Steps along the surface are across the normal.
        constexpr double k_step = 1e-6;
        for (int i = 0; i < 3; ++i) {
            const Vector3 along = point(out + k_step * random_direction(rng)) - hit.position;
            EXPECT_NEAR(glm::dot(hit.normal, along), 0, 1e-10);
        }
        EXPECT_EQ(hit.object_id, 9U);
        EXPECT_EQ(hit.reflectance[0], 0.4);
    }
}

TEST(SceneObjects, PlanesAreCrossedOnceAndFromBothSides) {
    const PlaneObject plane{{0, 0, 2}, glm::normalize(Vector3(0, 1, 1)), 3, {}};
    const auto t = cross_plane(plane, {5, 0, 0}, {0, 0, 2});
    EXPECT_NEAR(t.value(), 1, 1e-15);
    EXPECT_LT(cross_plane(plane, {5, 0, 9}, {0, 0, 2}).value(), 0);
    EXPECT_FALSE(cross_plane(plane, {5, 0, 0}, {1, 0, 0}));
    SurfaceHit hit;
    shade_plane(plane, {0, 0, 1}, hit);
    EXPECT_EQ(hit.normal, -plane.normal);
    shade_plane(plane, {0, 0, -1}, hit);
    EXPECT_EQ(hit.normal, plane.normal);
    EXPECT_EQ(hit.object_id, 3U);
}

}  // namespace
}  // namespace uw
