// ctest labels: unit
#include "core/meshes/files/assimp_reader.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/meshes/mesh_reading.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

using test::area_about_z;
using test::bytes_of;

class AssimpReader : public testing::Test {
  protected:
    TriangleMesh read(const std::string& name, bool normals, const std::string& bytes) {
        return read_with_assimp(folder_.write(name, bytes), normals);
    }
    test::MeshFolder folder_;
};

TEST_F(AssimpReader, SplitsObjPolygonsAlongTheirOutline) {
    // An arrowhead whose notch a fan from the first corner would fill; its area is 4.
    const TriangleMesh mesh = read("arrow.obj", true,
                                   "v 2 0 0\nv 4 4 0\nv 2 2 0\nv 0 4 0\n"
                                   "f 4 1 2 3\n");
    EXPECT_EQ(mesh.triangle_count(), 2U);
    EXPECT_DOUBLE_EQ(area_about_z(mesh), 4.0);
    EXPECT_EQ(mesh.materials.size(), 1U);
    EXPECT_EQ(mesh.materials[0].base_color, (Rgb{0.5, 0.5, 0.5}));
}

TEST_F(AssimpReader, ReadsStlOfBothKinds) {
    std::string binary(80, 'x');
    binary += bytes_of<std::uint32_t>({1});
    // The normal written is wrong on purpose: it must not be used.
    binary += bytes_of<float>({1, 0, 0, 0, 0, 0, 2, 0, 0, 0, 2, 0}) + std::string(2, '\0');
    const TriangleMesh mesh = read("one.stl", false, binary);
    EXPECT_EQ(mesh.triangle_count(), 1U);
    EXPECT_DOUBLE_EQ(area_about_z(mesh), 2.0);
    EXPECT_TRUE(mesh.normals.empty());
    const TriangleMesh text =
        read("text.stl", false,
             "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 0 2 0\n"
             "endloop\nendfacet\nendsolid s\n");
    EXPECT_DOUBLE_EQ(area_about_z(text), 2.0);
}

constexpr auto k_obj_with_normals = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 2\nf 1//1 2//1 3//1\n";

TEST_F(AssimpReader, TakesNormalsOnDemandAndMakesThemUnit) {
    const TriangleMesh mesh = read("n.obj", true, k_obj_with_normals);
    EXPECT_EQ(mesh.normals, (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}));
    EXPECT_TRUE(read("n.obj", false, k_obj_with_normals).normals.empty());
    EXPECT_TRUE(read("f.obj", true, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").normals.empty());
}

TEST_F(AssimpReader, JoinsTheObjectsOfAFile) {
    const TriangleMesh mesh = read("two.obj", true,
                                   "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
                                   "o b\nv 0 0 1\nv 2 0 1\nv 0 2 1\nf 4 5 6\nl 4 5\n");
    EXPECT_EQ(mesh.triangle_count(), 2U);  // the line is none
    EXPECT_DOUBLE_EQ(area_about_z(mesh), 0.5 + 2);
}

TEST_F(AssimpReader, LeavesDegenerateTrianglesIn) {
    EXPECT_EQ(read("d.obj", true, "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n").triangle_count(), 1U);
}

TEST_F(AssimpReader, OpensNoFileThatTheMeshNames) {
    // A material library could be a pipe, and reading it would wait for ever.
    folder_.write("m.mtl", "newmtl red\nKd 1 0 0\n");
    const TriangleMesh mesh = read("m.obj", true,
                                   "mtllib m.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                                   "f 1 2 3\n");
    EXPECT_EQ(mesh.triangle_count(), 1U);
    EXPECT_EQ(mesh.materials[0].base_color, (Rgb{0.5, 0.5, 0.5}));
}

TEST_F(AssimpReader, RefusesInOneLineWhatIsNoMesh) {
    for (const char* name : {"text.stl", "text.obj"}) {
        const std::string message = test::message_of<InputError>(
            [&] { read(name, true, "this is no mesh\nbut some\nlines of text\n"); });
        EXPECT_TRUE(message.starts_with(folder_.path(name).string() + ": cannot read the mesh"))
            << message;
    }
    EXPECT_THROW(read_with_assimp(folder_.path("none.obj"), true), InputError);
}

}  // namespace
}  // namespace uw
