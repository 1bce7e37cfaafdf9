// ctest labels: unit
#include "core/geometry/surfaces.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/sphere_surface.h"

namespace uw {
namespace {

// What surfaces get that answer one ray at a time.
TEST(SurfacesOneByOne, ManyRaysAreEachOnesAnswer) {
    const test::SphereSurface sphere({0, 0, 5}, 1);
    const std::array<Ray, 3> rays{Ray{{0, 0, 0}, {0, 0, 1}}, Ray{{0, 0, 0}, {0, 1, 0}},
                                  Ray{{0, 0, 9}, {0, 0, -1}}};
    std::array<SurfaceHit, 3> hits;
    std::array<char, 3> found{7, 7, 7};
    sphere.closest_hits(rays, 10, hits, found);
    EXPECT_EQ(found, (std::array<char, 3>{1, 0, 1}));
    EXPECT_EQ(hits[0].distance, 4);
    EXPECT_EQ(hits[2].distance, 3);
    EXPECT_EQ(hits[2].normal, Vector3(0, 0, 1));
    sphere.closest_hits(rays, 3.5, hits, found);
    EXPECT_EQ(found, (std::array<char, 3>{0, 0, 1}));
}

TEST(SurfacesOneByOne, ManyDistancesAndShadowsLikewise) {
    const test::SphereSurface sphere({0, 0, 5}, 1);
    const std::array<Vector3, 2> directions{Vector3(0, 0, 1), Vector3(1, 0, 0)};
    std::array<double, 2> distances{};
    sphere.hit_distances({0, 0, 1}, directions, distances);
    EXPECT_EQ(distances[0], 3);
    EXPECT_TRUE(std::isinf(distances[1]));
    const std::array<Point3, 4> ends{Point3{0, 0, 7}, Point3{0, 0, 3}, Point3{3, 0, 5},
                                     Point3{0, 0, 4}};  // the last is on the sphere
    std::array<char, 4> blocked{7, 7, 7, 7};
    sphere.occluded_many({0, 0, 0}, ends, blocked);
    EXPECT_EQ(blocked, (std::array<char, 4>{1, 0, 0, 0}));
}

TEST(SurfacesOneByOne, SurfacesOnlyReflectUnlessTheySayMore) {
    const SurfaceMaterial material = test::SphereSurface({0, 0, 5}, 1).material({});
    EXPECT_FALSE(material.is_glossy);
    EXPECT_EQ(material.emission[0], 0);
}

}  // namespace
}  // namespace uw
