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
    TriangleMesh read(const std::string& name, const std::string& bytes) {
        return read_stl(folder_.write(name, bytes));
    }
    test::MeshFolder folder_;
};

TEST_F(AssimpReader, ReadsStlOfBothKinds) {
    std::string binary(80, 'x');
    binary += bytes_of<std::uint32_t>({1});
    // The normal written is wrong on purpose: it must not be used.
    binary += bytes_of<float>({1, 0, 0, 0, 0, 0, 2, 0, 0, 0, 2, 0}) + std::string(2, '\0');
    const TriangleMesh mesh = read("one.stl", binary);
    EXPECT_EQ(mesh.triangle_count(), 1U);
    EXPECT_DOUBLE_EQ(area_about_z(mesh), 2.0);
    EXPECT_TRUE(mesh.normals.empty());
    const TriangleMesh text =
        read("text.stl",
             "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 0 2 0\n"
             "endloop\nendfacet\nendsolid s\n");
    EXPECT_DOUBLE_EQ(area_about_z(text), 2.0);
}

TEST_F(AssimpReader, RefusesInOneLineWhatIsNoMesh) {
    const std::string message = test::message_of<InputError>(
        [&] { read("text.stl", "this is no mesh\nbut some\nlines of text\n"); });
    EXPECT_TRUE(message.starts_with(folder_.path("text.stl").string() + ": cannot read the mesh"))
        << message;
    EXPECT_THROW(read_stl(folder_.path("none.stl")), InputError);
}

}  // namespace
}  // namespace uw
