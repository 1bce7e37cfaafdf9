// ctest labels: unit
#include "core/meshes/files/mesh_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <type_traits>

#include "core/base/error.h"
#include "tests/support/mesh_fixtures.h"
#include "tests/support/mesh_reading.h"

namespace uw {
namespace {

using test::bytes_of;
using test::corner_positions;
using test::gltf_text;

/// Sum of the triangles' areas, and whether all of them turn the same way about z.
double area_about_z(const TriangleMesh& mesh) {
    const std::vector<float> p = corner_positions(mesh);
    double area = 0;
    for (std::size_t t = 0; t < p.size(); t += 9) {
        const double ax = p[t + 3] - p[t], ay = p[t + 4] - p[t + 1];
        const double bx = p[t + 6] - p[t], by = p[t + 7] - p[t + 1];
        area += 0.5 * (ax * by - ay * bx);
    }
    return area;
}

class MeshReader : public test::MeshReading {};

TEST_F(MeshReader, SplitsObjPolygonsAlongTheirOutline) {
    // An arrowhead whose notch a fan from the first corner would fill; its area is 4.
    const TriangleMesh mesh = read("arrow.obj",
                                   "v 2 0 0\nv 4 4 0\nv 2 2 0\nv 0 4 0\n"
                                   "f 4 1 2 3\n");
    EXPECT_EQ(mesh.triangle_count(), 2U);
    EXPECT_DOUBLE_EQ(area_about_z(mesh), 4.0);
    EXPECT_EQ(mesh.materials.size(), 1U);
    EXPECT_EQ(mesh.materials[0].base_color, (Rgb{0.5, 0.5, 0.5}));
}

TEST_F(MeshReader, ReadsPlyInAllEncodings) {
    const std::string body =
        "element vertex 4\nproperty double x\nproperty float y\nproperty float z\n"
        "property uchar red\nelement face 1\nproperty list uchar short vertex_index\n"
        "property uchar flags\nelement extra 2\nproperty list uchar float f\nend_header\n";
    const std::string ascii = "0 0 7 9\n1 0 7 9\n1 1 7 9\n0 1 7 9\n4 0 1 2 3 1\n1 5\n0\n";
    std::string little, big;
    const auto put = [&](const auto value) {
        std::string bytes = bytes_of<std::decay_t<decltype(value)>>({value});
        little += bytes;
        big.append(bytes.rbegin(), bytes.rend());
    };
    for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        put(double(x)), put(float(y)), put(7.0F), put(std::uint8_t{9});
    }
    put(std::uint8_t{4});
    for (int k = 0; k < 4; ++k) put(static_cast<std::int16_t>(k));
    put(std::uint8_t{1});
    put(std::uint8_t{1}), put(5.0F), put(std::uint8_t{0});

    const auto check = [&](const std::string& text) {
        const TriangleMesh mesh = read("quad.ply", text);
        EXPECT_EQ(mesh.triangle_count(), 2U);
        EXPECT_EQ(mesh.positions, (std::vector<float>{0, 0, 7, 1, 0, 7, 1, 1, 7, 0, 1, 7}));
        EXPECT_DOUBLE_EQ(area_about_z(mesh), 1.0);
    };
    check("ply\nformat ascii 1.0\n" + body + ascii);
    check("ply\r\nformat ascii 1.0\r\n" + body + ascii);
    check("ply\nformat binary_little_endian 1.0\ncomment hello\n" + body + little);
    check("ply\nformat binary_big_endian 1.0\n" + body + big);
    // Each byte that is missing is noticed.
    for (std::size_t cut = 1; cut < little.size(); cut += 7) {
        EXPECT_NE(error_of("cut.ply", "ply\nformat binary_little_endian 1.0\n" + body +
                                          little.substr(0, little.size() - cut)),
                  "");
    }
}

TEST_F(MeshReader, ReadsStlGeometryOnly) {
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

TEST_F(MeshReader, DropsAndCountsBrokenTriangles) {
    const TriangleMesh mesh =
        read("bad.ply",
             "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
             "property float z\nelement face 6\nproperty list uchar int vertex_indices\n"
             "end_header\n0 0 0\n1 0 0\n0 1 0\nnan 0 0\ninf 0 0\n"
             "3 0 1 2\n3 0 1 3\n3 0 1 4\n3 0 1 1\n3 0 1 99\n3 0 1 -1\n");
    EXPECT_EQ(mesh.triangle_count(), 1U);
    ASSERT_EQ(warnings_.size(), 3U);
    EXPECT_NE(warnings_[0].find("2 triangles name vertices"), std::string::npos) << warnings_[0];
    EXPECT_NE(warnings_[1].find("2 triangles have corners"), std::string::npos) << warnings_[1];
    EXPECT_NE(warnings_[2].find("1 triangles have no area"), std::string::npos) << warnings_[2];
}

TEST_F(MeshReader, RefusesBrokenFilesInOneLine) {
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\n";
    EXPECT_NE(error_of("empty.ply", "").find("empty"), std::string::npos);
    EXPECT_NE(error_of("mesh.fbx", "x").find(".gltf, .glb, .obj, .ply and .stl"),
              std::string::npos);
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

TEST_F(MeshReader, SaysThatColoursOfAPlyAreIgnored) {
    read("coloured.ply",
         "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0 9 9 9\n1 0 0 9 9 9\n0 1 0 9 9 9\n3 0 1 2\n");
    ASSERT_EQ(warnings_.size(), 1U);
    EXPECT_TRUE(warnings_[0].ends_with("coloured.ply: ignored: vertex colours")) << warnings_[0];
}

TEST_F(MeshReader, ReadsTheProjectsSeabed) {
    const std::filesystem::path assets = std::filesystem::path(UWVDB_SOURCE_DIR) / "assets/meshes";
    const TriangleMesh mesh = read_mesh(assets / "seabed.glb", warnings_);
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
    const TriangleMesh cube = read_mesh(assets / "cube_quads.ply", warnings_);
    EXPECT_EQ(cube.triangle_count(), 12U);
}

TEST_F(MeshReader, ReadsTheSamplesIfTheyAreThere) {
    const char* folder = std::getenv("UWVDB_SAMPLES");
    if (folder == nullptr) return;  // set in continuous integration; nothing to look at elsewhere
    const std::filesystem::path samples = folder;
    const TriangleMesh apart = read_mesh(samples / "seabed_sep.gltf", warnings_);
    const TriangleMesh together = read_mesh(samples / "seabed.glb", warnings_);
    EXPECT_EQ(apart.positions, together.positions);
    EXPECT_EQ(apart.uvs, together.uvs);
    EXPECT_EQ(read_mesh(samples / "seabed_only.ply", warnings_).triangle_count(), 100352U);
    for (const char* lights : {"lights_raw.gltf", "lights_spec.gltf", "lights_compat.gltf"}) {
        EXPECT_EQ(read_mesh(samples / lights, warnings_).triangle_count(), 12U);
    }
}

}  // namespace
}  // namespace uw
