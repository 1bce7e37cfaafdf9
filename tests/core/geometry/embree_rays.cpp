// ctest labels: unit metamorphic
#include "core/geometry/embree_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/geometry/surfaces.h"
#include "tests/support/geometry_descs.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/sphere_surface.h"
#include "tests/support/surface_probes.h"

// Queries of many rays at once have the results of the queries one by one, to the bit.
namespace uw {
namespace {

using test::box;
using test::build;
using test::plane;
using test::Random;
using test::seabed;
using test::sphere;

void expect_equal(const SurfaceHit& many, const SurfaceHit& one) {
    EXPECT_EQ(many.distance, one.distance);
    EXPECT_EQ(many.position, one.position);
    EXPECT_EQ(many.normal, one.normal);
    EXPECT_EQ(many.geometric_normal, one.geometric_normal);
    EXPECT_EQ(many.reflectance, one.reflectance);
    EXPECT_EQ(many.object_id, one.object_id);
}

/// Compares closest_hits; returns how many rays hit.
int compare_hits(const Surfaces& surfaces, const std::vector<Ray>& rays, double s_end) {
    std::vector<SurfaceHit> hits(rays.size());
    std::vector<char> found(rays.size(), 7);
    surfaces.closest_hits(rays, s_end, hits, found);
    int count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        SCOPED_TRACE(i);
        SurfaceHit hit;
        EXPECT_EQ(found[i], surfaces.closest_hit(rays[i], s_end, hit) ? 1 : 0);
        expect_equal(hits[i], hit);  // of a miss, both are as they were
        count += found[i];
    }
    return count;
}

int compare_distances(const Surfaces& surfaces, const Point3& origin,
                      const std::vector<Vector3>& directions) {
    std::vector<double> distances(directions.size(), -1);
    surfaces.hit_distances(origin, directions, distances);
    int count = 0;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        EXPECT_EQ(distances[i], surfaces.hit_distance({origin, directions[i]})) << i;
        count += std::isfinite(distances[i]) ? 1 : 0;
    }
    return count;
}

int compare_shadows(const Surfaces& surfaces, const Point3& from, const std::vector<Point3>& to) {
    std::vector<char> blocked(to.size(), 7);
    surfaces.occluded_many(from, to, blocked);
    int count = 0;
    for (std::size_t i = 0; i < to.size(); ++i) {
        EXPECT_EQ(blocked[i], surfaces.occluded(from, to[i]) ? 1 : 0) << i;
        count += blocked[i];
    }
    return count;
}

void compare_shadows(const Surfaces& surfaces, const std::vector<Ray>& from,
                     const std::vector<Point3>& to) {
    std::vector<Point3> origins;
    for (const Ray& ray : from) origins.push_back(ray.origin);
    std::vector<char> blocked(to.size(), 7);
    surfaces.occluded_many(origins, to, blocked);
    for (std::size_t i = 0; i < to.size(); ++i)
        EXPECT_EQ(blocked[i], surfaces.occluded(origins[i], to[i]) ? 1 : 0) << i;
}

struct Counts {
    int rays = 0, hits = 0, distances = 0, shadows = 0;
};

/// Sends a bundle through all three queries: rays from about `origin` to points within `spread` of
/// `target`.
void compare(const Surfaces& surfaces, Random& random, const Point3& origin, const Point3& target,
             double spread, int count, Counts& counts) {
    std::vector<Ray> rays;
    std::vector<Vector3> directions;
    std::vector<Point3> ends;
    for (int i = 0; i < count; ++i) {
        const Point3 aim = target + spread * from_origin(random.point(1));
        directions.push_back(glm::normalize(aim - origin));
        const Vector3 shift = i % 3 == 0 ? Vector3(0.0) : 0.01 * from_origin(random.point(1));
        rays.push_back({origin + shift, directions.back()});
        ends.push_back(origin + random.uniform(0.5, 2) * (aim - origin));
    }
    counts.rays += count;
    counts.hits += compare_hits(surfaces, rays, random.uniform(1, 30));
    counts.distances += compare_distances(surfaces, origin, directions);
    counts.shadows += compare_shadows(surfaces, origin, ends);
    compare_shadows(surfaces, rays, ends);
}

std::vector<std::vector<GeometryDesc>> scenes() {
    const GeometryDesc floor = plane({0, 2.5, 0}, {0.1, 1, 0.2});
    GeometryDesc egg = sphere({0.5, 0, 0}, 0.8);
    egg.world_from_object = Affine::rotation_xyz_degrees({20, 30, 40}) * Affine::scale({1, 2, 0.5});
    return {{},
            {floor, plane({0, 0, 9}, {0, 0, 1})},
            {egg, sphere({1, 0.5, 2}, 0.4), sphere({1.2, 0.5, 2}, 0.4)},
            {box({-1, -1, -1}, {1, 1, 1}), box({-0.5, 0, 1}, {0.5, 2, 3})},
            {seabed()},
            {seabed(), egg, floor, box({-1, 0, -1}, {0, 1, 1}), sphere({-1, 0, 1}, 0.6)}};
}

TEST(SurfacesPackets, EqualSingleQueriesForBundlesOfEveryWidthAndCount) {
    Random random;
    for (std::size_t scene = 0; scene < scenes().size(); ++scene) {
        SCOPED_TRACE("scene " + std::to_string(scene));
        const auto surfaces = build(scenes()[scene]);
        Counts counts;
        for (int bundle = 0; bundle < 1200; ++bundle) {
            const double spread = std::pow(10, random.uniform(-4, 1));
            compare(*surfaces, random, random.point(4), random.point(1.5), spread, bundle % 19,
                    counts);
        }
        if (scene == 0) {
            EXPECT_EQ(counts.hits + counts.distances + counts.shadows, 0);
            continue;
        }
        // Neither all nor nothing, or little would have been compared.
        for (const int count : {counts.hits, counts.shadows}) {
            EXPECT_GT(count, counts.rays / 50);
            EXPECT_LT(count, counts.rays);
        }
        EXPECT_GE(counts.distances, counts.hits / 2);
    }
}

/// Two sheets of squares in the plane z = 0, of equal corners and of different numbers, and a wall
/// that stands on their edge x = 0.
std::string sheet_text() {
    std::string text;
    for (int k = 0; k < 81; ++k) {
        text += "v " + std::to_string(0.25 * (k % 9) - 1) + " " +
                std::to_string(0.25 * (k / 9) - 1) + " 0\n";
    }
    for (int k = 0; k < 64; ++k) {
        const int a = k / 8 * 9 + k % 8 + 1;
        const auto corner = [&](int step) { return " " + std::to_string(a + step); };
        text += "f" + corner(0) + corner(1) + corner(10) + "\nf" + corner(0) + corner(10) +
                corner(9) + "\n";
    }
    text += "v 0 -1 1\nv 0 1 1\nf 5 77 82\nf 77 83 82\n";
    return text;
}

/// A corner of the sheet, or a point on one of its edges, or a hair beside.
Point3 on_an_edge(Random& random, double hair) {
    const auto grid = [&] { return 0.25 * std::floor(random.uniform(-4, 5)); };
    Point3 point{grid(), grid(), 0};
    const double kind = random.uniform(0, 1);
    if (kind < 0.3) point.x = random.uniform(-1, 1);
    if (kind > 0.7) point.y = random.uniform(-1, 1);
    return point + hair * from_origin(random.point(1));
}

TEST(SurfacesPackets, TiesAndEdgesGoTheSameWay) {
    const test::MeshFolder folder;
    GeometryDesc sheet;
    sheet.file = folder.write("sheet.obj", sheet_text());
    const auto surfaces = build({sheet, sheet, box({-1.5, -0.5, 0.5}, {-0.5, 0.5, 1})});
    Random random;
    int hits = 0, rays_sent = 0;
    for (int bundle = 0; bundle < 3000; ++bundle) {
        Point3 origin = random.point(3);
        if (bundle % 4 == 0) origin = {0.25 * (bundle % 9) - 1, origin.y, origin.z};
        // Down to less than floats resolve.
        const double hair = std::pow(10, random.uniform(-9, -2));
        std::vector<Ray> rays;
        std::vector<Vector3> directions;
        std::vector<Point3> ends;
        for (int i = 0; i < 21; ++i) {
            const Point3 aim = on_an_edge(random, hair);
            directions.push_back(glm::normalize(aim - origin));
            rays.push_back({origin, directions.back()});
            ends.push_back(origin + 1.5 * (aim - origin));
        }
        rays_sent += 21;
        hits += compare_hits(*surfaces, rays, 1e6);
        compare_distances(*surfaces, origin, directions);
        compare_shadows(*surfaces, origin, ends);
    }
    EXPECT_GT(hits, rays_sent / 2);
}

TEST(SurfacesPackets, ManyEqualSheetsTie) {
    const test::MeshFolder folder;
    GeometryDesc sheet;
    sheet.file = folder.write("sheet.obj", sheet_text());
    // More than one box of Embree holds, so that a tie goes across boxes.
    const auto surfaces = build(std::vector<GeometryDesc>(20, sheet));
    Random random;
    for (int bundle = 0; bundle < 2000; ++bundle) {
        const Point3 origin{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, -1)};
        const Vector3 direction =
            glm::normalize(Point3{random.uniform(-1, 1), random.uniform(-1, 1), 0} - origin);
        std::vector<Ray> rays(1 + static_cast<std::size_t>(bundle) % 9, {origin, direction});
        EXPECT_EQ(compare_hits(*surfaces, rays, 1e6), static_cast<int>(rays.size()));
        SurfaceHit hit;
        surfaces->closest_hit(rays[0], 1e6, hit);
        EXPECT_EQ(hit.object_id, 1U);
    }
}

TEST(SurfacesPackets, RaysFromWithinASurfacePassOverIt) {
    const auto surfaces = build({box({-1, -1, -1}, {1, 1, 1}), sphere({3, 0, 0}, 1),
                                 plane({0, -4, 0}, {0, 1, 0}), seabed()});
    Random random;
    int hits = 0;
    for (int bundle = 0; bundle < 400; ++bundle) {
        // In the planes of the box's faces, inside and outside; on the sphere; in the plane.
        const std::array<Point3, 4> origins{
            Point3{1, random.uniform(-2, 2), random.uniform(-2, 2)},
            Point3{random.uniform(-1, 1), -1, random.uniform(-1, 1)},
            Point3{3, 0, 0} + random.direction(), Point3{random.uniform(-5, 5), -4, 0}};
        const Point3& origin = origins[static_cast<std::size_t>(bundle) % origins.size()];
        std::vector<Ray> rays;
        std::vector<Vector3> directions;
        std::vector<Point3> ends;
        const Vector3 middle = random.direction();
        for (int i = 0; i < 11; ++i) {
            Vector3 direction = glm::normalize(middle + 0.1 * random.direction());
            // Along a face, too.
            if (i % 3 == 0) direction = glm::normalize(Vector3(0, direction.y, direction.z));
            directions.push_back(direction);
            rays.push_back({origin, direction});
            // The last is of no length.
            ends.push_back(i == 10 ? origin : origin + random.uniform(0.1, 6) * direction);
        }
        hits += compare_hits(*surfaces, rays, 1e6);
        compare_distances(*surfaces, origin, directions);
        compare_shadows(*surfaces, origin, ends);
    }
    EXPECT_GT(hits, 1000);
}

TEST(SurfacesPackets, SurfacesWithoutPacketsAnswerOneByOne) {
    const test::SphereSurface surfaces({0, 0, 5}, 1);
    Random random;
    Counts counts;
    compare(surfaces, random, {0, 0, 0}, {0, 0, 5}, 2, 50, counts);
    EXPECT_GT(counts.distances, 5);
    EXPECT_LT(counts.distances, 50);
}

}  // namespace
}  // namespace uw
