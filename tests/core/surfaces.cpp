// ctest labels: unit analytic
#include "core/surfaces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "core/error.h"
#include "core/geometry_scene.h"
#include "core/mesh_reader.h"
#include "tests/support/mesh_fixtures.h"

namespace uw {
namespace {

const std::vector<double> k_bands{620, 540, 450};
constexpr double k_far = 1e6;

std::unique_ptr<Surfaces> build(const std::vector<GeometryDesc>& geometry) {
    std::vector<std::string> warnings;
    return build_surfaces(geometry, k_bands, warnings);
}

GeometryDesc sphere(const Point3& center, double radius) {
    GeometryDesc desc;
    desc.type = GeometryDesc::Type::sphere;
    desc.center = center;
    desc.radius = radius;
    return desc;
}

GeometryDesc box(const Point3& min, const Point3& max) {
    GeometryDesc desc;
    desc.type = GeometryDesc::Type::box;
    desc.min = min;
    desc.max = max;
    return desc;
}

GeometryDesc plane(const Point3& point, const Vector3& normal) {
    GeometryDesc desc;
    desc.type = GeometryDesc::Type::plane;
    desc.point = point;
    desc.normal = glm::normalize(normal);
    return desc;
}

GeometryDesc seabed() {
    GeometryDesc desc;
    desc.file = std::filesystem::path(UWVDB_SOURCE_DIR) / "assets/meshes/seabed.glb";
    return desc;
}

class Random {
  public:
    double uniform(double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(engine_);
    }
    Point3 point(double size) {
        return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
    }
    Vector3 direction() {
        const double z = uniform(-1, 1), phi = uniform(0, 2 * std::numbers::pi);
        return {std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z};
    }

  private:
    std::mt19937_64 engine_{20240611};
};

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

TEST(Surfaces, ClosestHitOnTheSeabedEqualsBruteForce) {
    std::vector<std::string> warnings;
    const TriangleMesh mesh = read_mesh(seabed().file, warnings);
    const auto surfaces = build({seabed()});
    EXPECT_EQ(surfaces->triangle_count(), mesh.triangle_count());
    Random random;
    int hits = 0, compared = 0;
    for (int k = 0; k < 600; ++k) {
        const Ray ray{Point3{random.uniform(-5, 5), random.uniform(0.3, 2), random.uniform(-5, 5)},
                      random.direction()};
        const Nearest expected = brute_force(mesh, ray);
        SurfaceHit hit;
        const bool found = surfaces->closest_hit(ray, k_far, hit);
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
        EXPECT_EQ(hit.object_id, 1U);
        for (int band = 0; band < 3; ++band) {
            const double rho = hit.reflectance[static_cast<std::size_t>(band)];
            EXPECT_TRUE(rho >= 0 && rho <= 1);
        }
    }
    EXPECT_GT(hits, 150);
    EXPECT_GT(compared, 500);
}

TEST(Surfaces, OcclusionOnTheSeabedEqualsBruteForceAndIsSymmetric) {
    std::vector<std::string> warnings;
    const TriangleMesh mesh = read_mesh(seabed().file, warnings);
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

TEST(Surfaces, ShadowRaysDoNotHitTheSurfaceTheyEndOn) {
    const auto surfaces = build({seabed(), sphere({0, 3, 0}, 0.5), plane({0, -2, 0}, {0, 1, 0})});
    Random random;
    const Point3 lamp{0.3, 1.7, 0.2};
    int lit = 0;
    for (int k = 0; k < 20000; ++k) {
        SurfaceHit hit;
        const Ray ray{lamp, random.direction()};
        if (!surfaces->closest_hit(ray, k_far, hit)) continue;
        ++lit;
        // What the lamp's own ray met first, the lamp lights, at any grazing angle.
        EXPECT_FALSE(surfaces->occluded(lamp, hit.position)) << k;
    }
    EXPECT_GT(lit, 10000);
}

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

TEST(Surfaces, TransformsIncludingMirrorsKeepNormalsRight) {
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
            ASSERT_TRUE(surfaces->closest_hit(ray, k_far, hit));
            // Vertices of up to 10 m in single precision.
            EXPECT_NEAR(hit.distance, 2.0, 2e-6);
            EXPECT_NEAR(glm::length(hit.geometric_normal - side * normal), 0.0, 2e-6);
            EXPECT_NEAR(glm::length(hit.normal - side * normal), 0.0, 2e-6);
        }
    }
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

TEST(Surfaces, ColorsMultiplyFactorTextureAndVertexColor) {
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
    ASSERT_TRUE(surfaces->closest_hit(behind, k_far, hit));
    EXPECT_NEAR(hit.reflectance[0], 0.5 * 1.0 * 0.5, 1e-7);  // red texel, factor, COLOR_0
    EXPECT_EQ(hit.reflectance[1], 0.0);
    EXPECT_EQ(hit.reflectance[2], 0.0);
    desc.reflectance = PerBand{0.3, 0.3, 0.3};
    ASSERT_TRUE(build({desc})->closest_hit(behind, k_far, hit));
    EXPECT_EQ(hit.reflectance[1], 0.3);
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
