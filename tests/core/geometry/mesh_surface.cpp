// ctest labels: unit analytic
#include "core/geometry/scene_objects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/mesh_reader.h"
#include "core/geometry/surfaces.h"
#include "tests/support/geometry_descs.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/surface_probes.h"

namespace uw {
namespace {

using test::build;
using test::plane;
using test::Random;
using test::seabed;
using test::sphere;

constexpr double k_beyond_mesh = 1e6;

struct Nearest {
    double t = std::numeric_limits<double>::infinity();
    double second = std::numeric_limits<double>::infinity();
    double rim = 1;  // how far inside its triangle the nearest crossing lies, 0 at an edge
    Vector3 normal{0.0};
};

/// All triangles one after the other, in double (Moeller & Trumbore 1997, as printed).
Nearest brute_force(const TriangleMesh& mesh, const Ray& ray) {
    Nearest best;
    const auto vertex = [&](std::uint32_t v) {
        return Vector3(mesh.positions[3 * v], mesh.positions[3 * v + 1], mesh.positions[3 * v + 2]);
    };
    const Vector3 origin = from_origin(ray.origin);
    for (std::size_t k = 0; k < mesh.triangles.size(); k += 3) {
        const Vector3 a = vertex(mesh.triangles[k]);
        const Vector3 e1 = vertex(mesh.triangles[k + 1]) - a;
        const Vector3 e2 = vertex(mesh.triangles[k + 2]) - a;
        const Vector3 p = glm::cross(ray.direction, e2);
        const double det = glm::dot(e1, p);
        if (det == 0) continue;
        const double u = glm::dot(origin - a, p) / det;
        const Vector3 q = glm::cross(origin - a, e1);
        const double v = glm::dot(ray.direction, q) / det;
        const double t = glm::dot(e2, q) / det;
        if (u < 0 || v < 0 || u + v > 1 || t <= 0) continue;
        if (t < best.t) {
            best = {t, best.t, std::min({u, v, 1 - u - v}), glm::normalize(glm::cross(e1, e2))};
        } else {
            best.second = std::min(best.second, t);
        }
    }
    return best;
}

TEST(SurfacesMesh, ClosestHitOnTheSeabedEqualsBruteForce) {
    std::vector<std::string> warnings;
    const TriangleMesh mesh = read_mesh(seabed().file, warnings).mesh;
    const auto surfaces = build({seabed()});
    EXPECT_EQ(surfaces->triangle_count(), mesh.triangle_count());
    Random random;
    int hits = 0, compared = 0;
    for (int k = 0; k < 600; ++k) {
        const Ray ray{Point3{random.uniform(-5, 5), random.uniform(0.3, 2), random.uniform(-5, 5)},
                      random.direction()};
        const Nearest expected = brute_force(mesh, ray);
        SurfaceHit hit;
        const bool found = surfaces->closest_hit(ray, k_beyond_mesh, hit);
        // Near an edge or a silhouette, Embree's single precision may take the neighbour.
        if (expected.rim < 1e-3) continue;
        ++compared;
        ASSERT_EQ(found, std::isfinite(expected.t)) << k;
        if (!found) continue;
        ++hits;
        // The same double formula on the same floats: rounding only, grazing rays included.
        EXPECT_NEAR(hit.distance, expected.t, 1e-9 * expected.t) << k;
        EXPECT_EQ(surfaces->hit_distance(ray), hit.distance);
        EXPECT_NEAR(std::abs(glm::dot(hit.geometric_normal, expected.normal)), 1.0, 1e-12);
        EXPECT_LE(glm::dot(hit.geometric_normal, ray.direction), 0.0);
        EXPECT_GE(glm::dot(hit.geometric_normal, hit.normal), 0.0);
        EXPECT_NEAR(glm::length(hit.normal), 1.0, 1e-12);
        EXPECT_TRUE(hit.object_id >= 1 && hit.object_id <= surfaces->names().objects.size());
        for (int band = 0; band < 3; ++band) {
            const double rho = hit.reflectance[static_cast<std::size_t>(band)];
            EXPECT_TRUE(rho >= 0 && rho <= 1);
        }
    }
    EXPECT_GT(hits, 150);
    EXPECT_GT(compared, 500);
}

TEST(SurfacesMesh, OcclusionOnTheSeabedEqualsBruteForceAndIsSymmetric) {
    std::vector<std::string> warnings;
    const TriangleMesh mesh = read_mesh(seabed().file, warnings).mesh;
    const auto surfaces = build({seabed()});
    Random random;
    int blocked = 0;
    for (int k = 0; k < 300; ++k) {
        const Point3 from{random.uniform(-2, 2), random.uniform(0, 1), random.uniform(-2, 2)};
        const Point3 to{random.uniform(-2, 2), random.uniform(0, 1), random.uniform(-2, 2)};
        const bool occluded = surfaces->occluded(from, to);
        EXPECT_EQ(occluded, surfaces->occluded(to, from));
        const double length = distance(from, to);
        const Nearest expected = brute_force(mesh, {from, (to - from) / length});
        const bool at_margin = expected.t < 1e-4 || std::abs(expected.t - length) < 1e-4 * length;
        if (expected.rim < 1e-3 || at_margin) continue;
        EXPECT_EQ(occluded, expected.t < length) << k;
        blocked += occluded ? 1 : 0;
    }
    EXPECT_GT(blocked, 30);
}

TEST(SurfacesMesh, ShadowRaysDoNotHitTheSurfaceTheyEndOn) {
    const auto surfaces = build({seabed(), sphere({0, 3, 0}, 0.5), plane({0, -2, 0}, {0, 1, 0})});
    Random random;
    const Point3 lamp{0.3, 1.7, 0.2};
    int lit = 0;
    for (int k = 0; k < 20000; ++k) {
        SurfaceHit hit;
        const Ray ray{lamp, random.direction()};
        if (!surfaces->closest_hit(ray, k_beyond_mesh, hit)) continue;
        ++lit;
        // What the lamp's own ray met first, the lamp lights, at any grazing angle.
        EXPECT_FALSE(surfaces->occluded(lamp, hit.position)) << k;
    }
    EXPECT_GT(lit, 10000);
}

TEST(SurfacesMesh, TransformsIncludingMirrorsKeepNormalsRight) {
    // A mesh of a slanted face with vertex normals that equal the flat one: n = (1, 1, 1) / sqrt 3.
    const test::MeshFolder folder;
    GeometryDesc desc;
    desc.file = folder.write("face.obj", "v 1 0 0\nv 0 1 0\nv 0 0 1\nvn 1 1 1\nf 1//1 2//1 3//1\n");
    for (const Vector3& scale : {Vector3(2, 3, 4), Vector3(-2, 3, 4), Vector3(-1, -1, -1)}) {
        desc.world_from_object = Affine::translation({5, 6, 7}) *
                                 Affine::rotation_xyz_degrees({20, -30, 40}) * Affine::scale(scale);
        const auto surfaces = build({desc});
        const Point3 a = desc.world_from_object * Point3{1, 0, 0};
        const Point3 b = desc.world_from_object * Point3{0, 1, 0};
        const Point3 c = desc.world_from_object * Point3{0, 0, 1};
        const Vector3 normal = glm::normalize(glm::cross(b - a, c - a));
        const Point3 middle =
            at_origin_plus((from_origin(a) + from_origin(b) + from_origin(c)) / 3.0);
        for (const double side : {1.0, -1.0}) {
            SurfaceHit hit;
            const Ray ray{middle + side * 2.0 * normal, -side * normal};
            ASSERT_TRUE(surfaces->closest_hit(ray, k_beyond_mesh, hit));
            // Vertices of up to 10 m in single precision.
            EXPECT_NEAR(hit.distance, 2.0, 2e-6);
            EXPECT_NEAR(glm::length(hit.geometric_normal - side * normal), 0.0, 2e-6);
            EXPECT_NEAR(glm::length(hit.normal - side * normal), 0.0, 2e-6);
        }
    }
}

TEST(SurfacesMesh, ColorsMultiplyFactorTextureAndVertexColor) {
    const test::MeshFolder folder;
    folder.write("t.png", test::four_texel_png());
    GeometryDesc desc;
    desc.file = folder.write(
        "look.gltf", test::gltf_text({{"meshes", R"([{"primitives":[{"attributes":
                            {"POSITION":0,"TEXCOORD_0":2,"COLOR_0":3},"indices":1,"material":0}]}])"},
                                      {"materials", R"([{"pbrMetallicRoughness":{"metallicFactor":0,
                            "baseColorFactor":[0.5,1,1,1],"baseColorTexture":{"index":0}}}])"},
                                      {"textures", R"([{"source":0}])"},
                                      {"images", R"([{"uri":"t.png"}])"}}));
    const auto surfaces = build({desc});
    SurfaceHit hit;
    const Ray behind{Point3{0.2, 0.2, -1}, Vector3(0, 0, 1)};  // one-sided, yet opaque and shaded
    ASSERT_TRUE(surfaces->closest_hit(behind, k_beyond_mesh, hit));
    EXPECT_NEAR(hit.reflectance[0], 0.5 * 1.0 * 0.5, 1e-7);  // red texel, factor, COLOR_0
    EXPECT_EQ(hit.reflectance[1], 0.0);
    EXPECT_EQ(hit.reflectance[2], 0.0);
    desc.reflectance = PerBand{0.3, 0.3, 0.3};
    ASSERT_TRUE(build({desc})->closest_hit(behind, k_beyond_mesh, hit));
    EXPECT_EQ(hit.reflectance[1], 0.3);
}

}  // namespace
}  // namespace uw
