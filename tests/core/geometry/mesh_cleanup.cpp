// ctest labels: unit
#include "core/geometry/mesh_reader.h"

#include <gtest/gtest.h>

#include <limits>

namespace uw {
namespace {

using TriangleIndices = std::vector<std::uint32_t>;

constexpr float k_broken_nan = std::numeric_limits<float>::quiet_NaN();
constexpr float k_broken_infinity = std::numeric_limits<float>::infinity();

/// Vertices 0, 1, 2 are a triangle, 3 lies on the line of 0 and 1; 4 to 6 are broken.
TriangleMesh corners_good_and_bad() {
    TriangleMesh mesh;
    mesh.positions = {0, 0, 0, 1, 0,    0, 0, 1, 0, 5, 0, 0, 0, k_broken_nan, 0, k_broken_infinity,
                      0, 0, 0, 0, 2e15F};
    return mesh;
}

TEST(MeshCleanup, KeepsWhatCanBeTracedInItsOrder) {
    TriangleMesh mesh = corners_good_and_bad();
    mesh.triangles = {0, 1, 2, 0, 1, 3, 2, 1, 3, 0, 1, 4, 3, 2, 1};
    mesh.triangle_materials = {7, 8, 9, 10, 11};
    DroppedTriangles dropped;
    drop_bad_triangles(mesh, dropped);
    EXPECT_EQ(mesh.triangles, (TriangleIndices{0, 1, 2, 2, 1, 3, 3, 2, 1}));
    EXPECT_EQ(mesh.triangle_materials, (TriangleIndices{7, 9, 11}));
    EXPECT_EQ(mesh.vertex_count(), 7U);  // vertices stay
}

TEST(MeshCleanup, CountsEachFaultOnce) {
    TriangleMesh mesh = corners_good_and_bad();
    mesh.triangles = {0, 1, 7, 0, 1, 4294967295U,
                      4, 5, 7,  // an index beyond goes first
                      0, 1, 4, 0, 5, 2,
                      6, 1, 2,            // not finite, or too far
                      0, 1, 3, 1, 1, 2};  // without area
    DroppedTriangles dropped;
    dropped.no_area = 10;  // of another part of the same file
    drop_bad_triangles(mesh, dropped);
    EXPECT_TRUE(mesh.triangles.empty());
    EXPECT_EQ(dropped.missing_corner, 3U);
    EXPECT_EQ(dropped.not_finite, 3U);
    EXPECT_EQ(dropped.no_area, 12U);
}

TEST(MeshCleanup, SmallTrianglesAreNoFault) {
    TriangleMesh mesh;
    mesh.positions = {0, 0, 0, 1e-12F, 0, 0, 0, 1e-12F, 0};
    mesh.triangles = {0, 1, 2};
    DroppedTriangles dropped;
    drop_bad_triangles(mesh, dropped);
    EXPECT_EQ(mesh.triangle_count(), 1U);
}

TEST(MeshCleanup, FlattensNormalsThatAreNoDirections) {
    TriangleMesh mesh = corners_good_and_bad();
    mesh.normals = {0, 0,     1, 0, 0, 0, k_broken_nan, 0, 1, k_broken_infinity, 0, 0,
                    0, 1e-7F, 0, 2, 0, 0, 3e6F,         0, 0};
    DroppedTriangles dropped;
    drop_bad_triangles(mesh, dropped);
    EXPECT_EQ(mesh.normals,
              (std::vector<float>{0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0}));
}

TEST(MeshCleanup, ReportsOneLinePerKind) {
    std::vector<std::string> warnings{"before"};
    DroppedTriangles{}.report("a.ply", warnings);
    EXPECT_EQ(warnings.size(), 1U);
    DroppedTriangles{2, 0, 5}.report("a.ply", warnings);
    EXPECT_EQ(warnings,
              (std::vector<std::string>{
                  "before", "a.ply: 2 triangles refer to vertices that do not exist; dropped",
                  "a.ply: 5 triangles have no area; dropped"}));
}

}  // namespace
}  // namespace uw
