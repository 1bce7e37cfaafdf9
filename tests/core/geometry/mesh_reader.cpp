// ctest labels: unit
#include "core/geometry/mesh_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "core/base/error.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/meshes/mesh_reading.h"

namespace uw {
namespace {

using test::gltf_text;

class MeshReader : public test::MeshReading {};

TEST_F(MeshReader, DropsAndCountsBrokenTriangles) {
    const TriangleMesh mesh =
        read("bad.ply",
             "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
             "property float z\nelement face 6\nproperty list uchar int vertex_indices\n"
             "end_header\n0 0 0\n1 0 0\n0 1 0\nnan 0 0\ninf 0 0\n"
             "3 0 1 2\n3 0 1 3\n3 0 1 4\n3 0 1 1\n3 0 1 99\n3 0 1 -1\n");
    EXPECT_EQ(mesh.triangle_count(), 1U);
    ASSERT_EQ(warnings_.size(), 3U);
    EXPECT_NE(warnings_[0].find("2 triangles refer to vertices"), std::string::npos)
        << warnings_[0];
    EXPECT_NE(warnings_[1].find("2 triangles have corners"), std::string::npos) << warnings_[1];
    EXPECT_NE(warnings_[2].find("1 triangles have no area"), std::string::npos) << warnings_[2];
}

TEST_F(MeshReader, RefusesBrokenFilesInOneLine) {
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\n";
    EXPECT_NE(error_of("empty.ply", "").find("empty"), std::string::npos);
    EXPECT_NE(error_of("mesh.fbx", "x").find(".gltf, .glb, .obj, .ply or .stl"), std::string::npos);
    EXPECT_NE(error_of("text.ply", "what is this"), "");
    EXPECT_NE(error_of("word.ply", ply + "end_header\n0 0 zero\n").find("zero"), std::string::npos);
    // A forged count is refused before anything is allocated for it.
    EXPECT_NE(error_of("forged.ply", ply + "element face 1000000000000\n"
                                           "property list uchar int vertex_indices\nend_header\n")
                  .find("promises"),
              std::string::npos);
    EXPECT_NE(error_of("none.ply", ply + "end_header\n0 0 0\n0 0 0\n0 0 0\n").find("no triangles"),
              std::string::npos);
    for (const char* name : {"text.stl", "text.obj", "text.glb", "text.gltf"}) {
        EXPECT_NE(error_of(name, "this is no mesh at all, only some text"), "") << name;
    }
    EXPECT_NE(error_of("cut.gltf", gltf_text().substr(0, 300)), "");
    EXPECT_THROW(read_mesh(folder_.path("missing.glb"), warnings_), IoError);
}

TEST_F(MeshReader, ReadsTheProjectsSeabed) {
    const std::filesystem::path assets = std::filesystem::path(UWVDB_SOURCE_DIR) / "assets/meshes";
    const TriangleMesh mesh = read_mesh(assets / "seabed.glb", warnings_).mesh;
    // Counted from the file's index accessors: 301056 / 3 of the grid, rocks, cube, rings, pipe.
    EXPECT_EQ(mesh.triangle_count(), 110408U);
    EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
    // The grid is the first mesh, untransformed: its bounds are in the file's own JSON.
    float lowest = 0, highest = 0;
    for (std::size_t v = 0; v < 50625; ++v) {
        lowest = std::min(lowest, mesh.positions[3 * v + 1]);
        highest = std::max(highest, mesh.positions[3 * v + 1]);
    }
    EXPECT_EQ(lowest, -0.1977550983428955F);
    EXPECT_EQ(highest, 0.19117094576358795F);
    const TriangleMesh cube = read_mesh(assets / "cube_quads.ply", warnings_).mesh;
    EXPECT_EQ(cube.triangle_count(), 12U);
}

TEST_F(MeshReader, ReadsTheSamplesIfTheyAreThere) {
    const char* folder = std::getenv("UWVDB_SAMPLES");
    if (folder == nullptr) return;  // set in continuous integration; nothing to look at elsewhere
    const std::filesystem::path samples = folder;
    const TriangleMesh apart = read_mesh(samples / "seabed_sep.gltf", warnings_).mesh;
    const TriangleMesh together = read_mesh(samples / "seabed.glb", warnings_).mesh;
    EXPECT_EQ(apart.positions, together.positions);
    EXPECT_EQ(apart.uvs, together.uvs);
    EXPECT_EQ(read_mesh(samples / "seabed_only.ply", warnings_).mesh.triangle_count(), 100352U);
    for (const char* lights : {"lights_raw.gltf", "lights_spec.gltf", "lights_compat.gltf"}) {
        EXPECT_EQ(read_mesh(samples / lights, warnings_).mesh.triangle_count(), 12U);
    }
}

}  // namespace
}  // namespace uw
