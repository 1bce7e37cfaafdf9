// ctest labels: unit
#include "core/geometry/stl_reader.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/meshes/mesh_reading.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

using test::area_about_z;
using test::bytes_of;
using test::corner_positions;

class StlReader : public testing::Test {
  protected:
    TriangleMesh read(const std::string& name, const std::string& bytes) {
        return read_stl(folder_.write(name, bytes));
    }
    std::string error_of(const std::string& name, const std::string& bytes) {
        const std::string message = test::message_of<InputError>([&] { read(name, bytes); });
        EXPECT_TRUE(message.starts_with(folder_.path(name).string() + ":")) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        return message;
    }
    /// A binary file that promises `count` triangles and holds those given, 9 numbers each. The
    /// normals are wrong on purpose: they must not be used.
    static std::string binary(std::uint32_t count, const std::vector<std::vector<float>>& triangles,
                              std::string header = "x") {
        header.resize(80, ' ');
        std::string bytes = header + bytes_of<std::uint32_t>({count});
        for (const std::vector<float>& vertices : triangles)
            bytes += bytes_of<float>({1, 0, 0}) + bytes_of(vertices) + "\x1f\x7c";  // and a colour
        return bytes;
    }
    static std::string text(const std::string& vertices) {
        return "solid a part of it\nfacet normal 0 0 1\nouter loop\n" + vertices +
               "endloop\nendfacet\nendsolid a part of it\n";
    }

    static inline const std::vector<float> k_half_square{0, 0, 0, 2, 0, 0, 0, 2, 0};
    static inline const std::vector<float> k_above{0, 0, 1, 3, 0, 1, 0, 1, 1};
    static inline const std::string k_vertices = "vertex 0 0 0\nvertex 2 0 0\nvertex 0 2 0\n";
    test::MeshFolder folder_;
};

TEST_F(StlReader, ReadsBinaryFiles) {
    const TriangleMesh mesh = read("two.stl", binary(2, {k_half_square, k_above}));
    std::vector<float> both = k_half_square;
    both.insert(both.end(), k_above.begin(), k_above.end());
    EXPECT_EQ(corner_positions(mesh), both);
    EXPECT_TRUE(mesh.normals.empty());
    // Embree reads 16 bytes at each vertex.
    EXPECT_GE(mesh.positions.capacity(), mesh.positions.size() + 1);
}

// More triangles than are read at once, the last of which is only a part of such a block.
TEST_F(StlReader, ReadsManyTriangles) {
    std::vector<std::vector<float>> triangles;
    for (int i = 0; i < 10'000; ++i)
        triangles.push_back({0, 0, static_cast<float>(i), 1, 0, 0, 0, 1, 0});
    const TriangleMesh mesh = read("many.stl", binary(10'000, triangles));
    ASSERT_EQ(mesh.triangle_count(), 10'000U);
    for (std::size_t i = 0; i < 10'000; ++i)
        ASSERT_EQ(mesh.positions[9 * i + 2], static_cast<float>(i));
    EXPECT_DOUBLE_EQ(area_about_z(mesh), 5000);
}

TEST_F(StlReader, TellsBinaryFilesThatBeginLikeText) {
    const std::string file = binary(1, {k_half_square}, "solid by some program");
    EXPECT_EQ(corner_positions(read("exact.stl", file)), k_half_square);
    EXPECT_EQ(corner_positions(read("more.stl", file + "and more")), k_half_square);
}

TEST_F(StlReader, ReadsTextWhereverItsLinesBreak) {
    EXPECT_EQ(corner_positions(read("text.stl", text(k_vertices))), k_half_square);
    EXPECT_EQ(corner_positions(read("dos.stl",
                                    "\r\n  SOLID\r\n\tFACET NORMAL nan nan nan\r\nOUTER LOOP\r\n"
                                    "VERTEX 0 0 0\r\nVERTEX 2. 0 0\r\nVERTEX 0 2e0 0\r\nENDLOOP\r\n"
                                    "ENDFACET\r\nENDSOLID")),
              k_half_square);
    const TriangleMesh two = read("two.stl", text("vertex 0 0 0 vertex 2 0 0 vertex 0 2 0\n") +
                                                 "solid b\nfacet normal 0 0 1 outer loop\n" +
                                                 k_vertices + "endloop endfacet\nendsolid b");
    EXPECT_EQ(two.triangle_count(), 2U);
    EXPECT_DOUBLE_EQ(area_about_z(two), 4);
}

TEST_F(StlReader, KeepsWhatIsNotFinite) {
    const float infinity = std::numeric_limits<float>::infinity();
    const TriangleMesh mesh = read("binary.stl", binary(1, {{infinity, 0, 0, 2, 0, 0, 0, 2, 0}}));
    EXPECT_EQ(mesh.positions[0], infinity);
    EXPECT_TRUE(std::isnan(
        read("text.stl", text("vertex inf 0 0\nvertex 2 0 0\nvertex 0 2 0\n")).positions[0]));
}

// Other work on a mesh asks as well: this is the reader's own.
TEST_F(StlReader, IsStoppedWithinBothKinds) {
    for (const std::string& bytes : {binary(1, {k_half_square}), text(k_vertices)}) {
        const std::filesystem::path file = folder_.write("a.stl", bytes);
        const std::atomic<bool> stop = true;
        const StopScope scope(stop);
        EXPECT_THROW(read_stl(file), Interrupted);
    }
}

TEST_F(StlReader, RefusesInOneLineWhatIsNoMesh) {
    EXPECT_NE(error_of("short.stl", "this is\nno mesh").find("neither"), std::string::npos);
    EXPECT_NE(error_of("long.stl", "this is no mesh\nbut some\n" + std::string(200, 'x'))
                  .find("no STL text"),
              std::string::npos);
    // A forged count is refused before anything is allocated for it.
    EXPECT_NE(error_of("forged.stl", binary(4'000'000'000, {k_half_square})).find("4000000000"),
              std::string::npos);
    EXPECT_NE(error_of("cut.stl", binary(1, {k_half_square}).substr(0, 133)).find("promises"),
              std::string::npos);
    EXPECT_THROW(read_stl(folder_.path("none.stl")), IoError);
}

TEST_F(StlReader, NamesTheLineOfBrokenText) {
    EXPECT_NE(error_of("word.stl", text("vertex 0 0 zero\n")).find(":4: 'zero'"),
              std::string::npos);
    EXPECT_NE(error_of("few.stl", text("vertex 0 0\n")).find(":4: ''"), std::string::npos);
    EXPECT_NE(error_of("colour.stl", text("colour 1\n")).find(":4: 'colour'"), std::string::npos);
    EXPECT_NE(error_of("line.stl", text("vertex 0 0 0\nvertex 1 0 0\n")).find(":6: a facet of 2"),
              std::string::npos);
    EXPECT_NE(error_of("quad.stl", text(k_vertices + "vertex 2 2 0\n")).find(":8: a facet of 4"),
              std::string::npos);
    EXPECT_NE(error_of("cut.stl", "solid\nfacet normal 0 0 1\nouter loop\n" + k_vertices)
                  .find("within a facet"),
              std::string::npos);
}

}  // namespace
}  // namespace uw
