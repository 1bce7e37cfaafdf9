// ctest labels: unit
#include "core/geometry/obj_reader.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/meshes/mesh_reading.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

using test::area_about_z;
using Values = std::vector<float>;

class ObjReader : public testing::Test {
  protected:
    MeshFile read(const std::string& text) {
        return read_obj(folder_.write("m.obj", text), false, warnings_);
    }
    std::string error_of(const std::string& text) {
        return test::message_of<InputError>([&] { read(text); });
    }
    test::MeshFolder folder_;
    std::vector<std::string> warnings_;
};

constexpr auto k_corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST_F(ObjReader, SplitsPolygonsAlongTheirOutline) {
    // An arrowhead whose notch a fan from the first corner would fill; its area is 4.
    const TriangleMesh mesh = read("v 2 0 0\nv 4 4 0\nv 2 2 0\nv 0 4 0\nf 4 1 2 3\n").mesh;
    EXPECT_EQ(mesh.triangle_count(), 2U);
    EXPECT_DOUBLE_EQ(area_about_z(mesh), 4.0);
    EXPECT_EQ(mesh.materials.size(), 1U);
    EXPECT_EQ(mesh.materials[0].base_color, (Rgb{0.5, 0.5, 0.5}));
    EXPECT_EQ(mesh.vertex_count(), 4U);  // corners that are alike share a vertex
}

TEST_F(ObjReader, TakesNormalsAndMakesThemUnit) {
    const TriangleMesh mesh =
        read(std::string(k_corners) + "vn 0 0 2\nf 1//1 2//1 3//1\nf 3 2 1\n").mesh;
    // The second face has none: its corners are vertices of their own.
    EXPECT_EQ(mesh.normals, (Values{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
    EXPECT_TRUE(read(std::string(k_corners) + "f 1 2 3\n").mesh.normals.empty());
}

TEST_F(ObjReader, ObjectsAreObjectsWithTheirNames) {
    const MeshFile file = read(
        "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\ng wing\nf 1 2 3\n"
        "o nothing\no b c\r\nv 0 0 1\nv 2 0 1\nv 0 2 1\nf 4 5 6\nl 4 5\no a\nf 3 2 1\n");
    EXPECT_EQ(file.objects, (std::vector<std::string>{"a", "b c"}));
    EXPECT_EQ(file.mesh.triangle_objects, (std::vector<std::uint32_t>{0, 1, 0}));
    EXPECT_DOUBLE_EQ(area_about_z(file.mesh), 0.5 + 2 - 0.5);
}

TEST_F(ObjReader, GroupsAreObjectsWhereNothingElseIs) {
    const MeshFile file = read(std::string(k_corners) + "f 1 2 3\ng left\nf 1 2 3\n");
    EXPECT_EQ(file.objects, (std::vector<std::string>{"m", "left"}));  // the first by its file
    EXPECT_TRUE(read(std::string(k_corners) + "f 1 2 3\n").mesh.triangle_objects.empty());
}

TEST_F(ObjReader, CountsBackwardsFromTheLastVertexRead) {
    const MeshFile file = read(std::string(k_corners) +
                               "f -3 -2 -1\nv 0 0 5\nv 1 0 5\nv 0 1 5\n"
                               "f -3 -2 -1\nf 1 2 \\\n 3\n");
    EXPECT_EQ(file.mesh.triangle_count(), 3U);
    const Values corners = test::corner_positions(file.mesh);
    EXPECT_EQ(corners[2], 0);
    EXPECT_EQ(corners[9 + 2], 5);
}

TEST_F(ObjReader, FacesMayComeBeforeTheirVertices) {
    EXPECT_DOUBLE_EQ(area_about_z(read(std::string("f 1 2 3\n") + k_corners).mesh), 0.5);
}

TEST_F(ObjReader, VertexColoursAreDecodedFromSrgb) {
    const TriangleMesh mesh = read("v 0 0 0 1 0 0.5\nv 1 0 0 0.04 2 -1\nv 0 1 0\nf 1 2 3\n").mesh;
    ASSERT_EQ(mesh.colors.size(), 9U);
    // IEC 61966-2-1: 0.5 is 0.21404, 0.04 lies on the straight piece.
    EXPECT_FLOAT_EQ(mesh.colors[0], 1);
    EXPECT_EQ(mesh.colors[1], 0);
    EXPECT_NEAR(mesh.colors[2], 0.21404114, 1e-7);
    EXPECT_NEAR(mesh.colors[3], 0.04 / 12.92, 1e-8);
    EXPECT_GT(mesh.colors[4], 1);  // out of range, which is for clamp_values
    EXPECT_LT(mesh.colors[5], 0);
    EXPECT_EQ(mesh.colors[6], 1);  // a vertex without
    EXPECT_EQ(mesh.materials[0].base_color, (Rgb{1, 1, 1}));
}

// Each face has normals of its own at the same three positions: quadratic if every corner were
// compared with all of them.
TEST_F(ObjReader, ManyCombinationsAtAPosition) {
    std::string text = k_corners;
    constexpr int k_faces = 50000;
    for (int k = 1; k <= k_faces; ++k) {
        const std::string n = std::to_string(k);
        text += "vn 0 0 1\nf 1//" + n + " 2//" + n + " 3//" + n + "\n";
    }
    const TriangleMesh mesh = read(text).mesh;
    EXPECT_EQ(mesh.triangle_count(), std::size_t{k_faces});
    EXPECT_EQ(mesh.vertex_count(), std::size_t{3 * k_faces});
}

TEST_F(ObjReader, IndicesOutOfRangeAreKeptForTheirCount) {
    const TriangleMesh mesh = read(std::string(k_corners) +
                                   "f 1 2 99\nf -9 1 2\nf 1 2 3\nf 1/7/7 2/7/7 3/7/7\n"
                                   "f 1 2 99999999999999999999\n")
                                  .mesh;
    EXPECT_EQ(mesh.triangle_count(), 5U);
    std::vector<std::string> warnings;
    const MeshFile kept = read_mesh(folder_.path("m.obj"), warnings);
    EXPECT_EQ(kept.mesh.triangle_count(), 2U);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("3 triangles refer to vertices that do not exist"),
              std::string::npos);
}

// Beyond what a double holds, as well as beyond single precision.
TEST_F(ObjReader, CoordinatesThatAreTooLargeAreCountedAndTooSmallOnesAreZero) {
    const TriangleMesh mesh = read(std::string(k_corners) +
                                   "v 1e400 0 0\nv -1E+400 0 0\nv 1e39 0 0\nv 5 1e-400 -1E-400\n"
                                   "f 1 2 4\nf 1 2 5\nf 1 2 6\nf 1 7 3\n")
                                  .mesh;
    EXPECT_EQ(mesh.triangle_count(), 4U);
    std::vector<std::string> warnings;
    const MeshFile kept = read_mesh(folder_.path("m.obj"), warnings);
    EXPECT_EQ(kept.mesh.triangle_count(), 1U);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("3 triangles have corners"), std::string::npos) << warnings[0];
    const std::vector<float> corners = test::corner_positions(kept.mesh);
    ASSERT_EQ(corners.size(), 9U);
    EXPECT_EQ(std::vector<float>(corners.begin() + 3, corners.begin() + 6),
              (std::vector<float>{5, 0, 0}));
}

TEST_F(ObjReader, BrokenNumbersAreNamedWithTheirLine) {
    const std::string name = folder_.path("m.obj").string();
    EXPECT_TRUE(error_of("v 0 0 0\nv 1 zero 0\n").starts_with(name + ":2: 'zero'"));
    EXPECT_TRUE(error_of("v 0 0\n").starts_with(name + ":1: "));
    EXPECT_TRUE(error_of(std::string(k_corners) + "f 1 2 x\n").starts_with(name + ":4: 'x'"));
    EXPECT_TRUE(error_of(std::string(k_corners) + "f 1 2 0\n").starts_with(name + ":4: '0'"));
    EXPECT_THROW(read_obj(folder_.path("none.obj"), false, warnings_), IoError);
}

}  // namespace
}  // namespace uw
