// ctest labels: unit
#include "core/geometry/ply_reader.h"

#include <gtest/gtest.h>

#include <type_traits>

#include "core/base/error.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/meshes/mesh_reading.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

using test::area_about_z;
using test::bytes_of;

constexpr std::uint32_t k_missing_vertex = 4294967295U;

class PlyReader : public testing::Test {
  protected:
    TriangleMesh read(const std::string& bytes) {
        return read_ply(folder_.write("mesh.ply", bytes), warnings_);
    }
    std::string error_of(const std::string& bytes) {
        return test::message_of<InputError>([&] { read(bytes); });
    }
    /// An ascii file of three vertices on the axes and what follows.
    static std::string with_three_vertices(const std::string& more_header,
                                           const std::string& more_body) {
        return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\n" +
               more_header + "end_header\n1 0 0\n0 1 0\n0 0 1\n" + more_body;
    }
    static std::string with_faces(int count, const std::string& body) {
        return with_three_vertices(
            "element face " + std::to_string(count) + "\nproperty list uchar int vertex_indices\n",
            body);
    }

    test::MeshFolder folder_;
    std::vector<std::string> warnings_;
};

TEST_F(PlyReader, ReadsAllEncodings) {
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
        const TriangleMesh mesh = read(text);
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
        EXPECT_NE(error_of("ply\nformat binary_little_endian 1.0\n" + body +
                           little.substr(0, little.size() - cut)),
                  "");
    }
}

TEST_F(PlyReader, DecodesVertexColoursFromSrgb) {
    const auto colored = [](const std::string& type, const std::string& first) {
        return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nproperty " +
               type + " red\nproperty " + type + " green\nproperty " + type +
               " blue\nproperty uchar alpha\nelement face 1\n"
               "property list uchar int vertex_indices\nend_header\n0 0 0 " +
               first + " 7\n1 0 0 0 0 0 7\n0 1 0 0 0 0 7\n3 0 1 2\n";
    };
    // IEC 61966-2-1: a code of 188 is 0.5029, of 128 0.2159; of 10 it is on the straight piece.
    const TriangleMesh bytes = read(colored("uchar", "188 128 10"));
    ASSERT_EQ(bytes.colors.size(), 9U);
    EXPECT_NEAR(bytes.colors[0], 0.50288646, 1e-7);
    EXPECT_NEAR(bytes.colors[1], 0.21586050, 1e-7);
    EXPECT_NEAR(bytes.colors[2], 10 / 255.0 / 12.92, 1e-9);
    EXPECT_EQ(bytes.materials[0].base_color, (Rgb{1, 1, 1}));
    const TriangleMesh shorts = read(colored("ushort", "48316 32896 2570"));  // 257 times those
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(shorts.colors[k], bytes.colors[k], 1e-7);
    const TriangleMesh floats = read(colored("float", "0.5 2 -1"));
    EXPECT_NEAR(floats.colors[0], 0.21404114, 1e-7);
    EXPECT_GT(floats.colors[1], 1);  // out of range, which is for clamp_values
    EXPECT_LT(floats.colors[2], 0);
    EXPECT_TRUE(warnings_.empty());
    EXPECT_TRUE(read(colored("int", "1 1 1")).colors.empty());
    ASSERT_EQ(warnings_.size(), 1U);
    EXPECT_NE(warnings_[0].find("ignored: vertex colours that are not"), std::string::npos);
}

TEST_F(PlyReader, SaysThatColoursOfFacesAreIgnored) {
    const TriangleMesh mesh = read(with_three_vertices(
        "element face 1\nproperty list uchar int vertex_indices\nproperty uchar red\n",
        "3 0 1 2 9\n"));
    EXPECT_EQ(mesh.materials[0].base_color, (Rgb{0.5, 0.5, 0.5}));
    ASSERT_EQ(warnings_.size(), 1U);
    EXPECT_TRUE(warnings_[0].ends_with("mesh.ply: ignored: colours of faces")) << warnings_[0];
}

TEST_F(PlyReader, TakesNormalsIfAllThreeAreThere) {
    const std::string body = "0 0 9 0 0 1\n1 0 9 0 0 1\n0 1 9 0 1 0\n";
    const auto file = [&](const char* last) {
        return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nproperty float nx\nproperty float ny\nproperty float " +
               std::string(last) + "\nend_header\n" + body;
    };
    EXPECT_EQ(read(file("nz")).normals, (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 1, 0}));
    EXPECT_TRUE(read(file("quality")).normals.empty());
}

TEST_F(PlyReader, MayHaveFacesOfMixedSizes) {
    const TriangleMesh mesh = read(with_faces(4, "3 0 1 2\n2 0 1\n0\n4 0 1 2 0\n"));
    ASSERT_EQ(mesh.triangle_count(), 3U);  // lines and points give none
    EXPECT_EQ((std::vector(mesh.triangles.begin(), mesh.triangles.begin() + 3)),
              (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST_F(PlyReader, LeavesCornersThatAreNotThereToBeCounted) {
    const TriangleMesh mesh = read(with_faces(3, "3 0 1 3\n3 -1 1 2\n4 0 1 2 99\n"));
    EXPECT_EQ(mesh.triangles, std::vector<std::uint32_t>(9, k_missing_vertex));
}

TEST_F(PlyReader, PassesOverOtherElements) {
    const TriangleMesh mesh = read(
        with_three_vertices("element edge 2\nproperty int vertex1\nproperty list int float extra\n"
                            "element face 1\nproperty list uchar int vertex_index\n"
                            "element nothing 1000000000000\n",
                            "5 3 1 2 3\n6 0\n3 0 1 2"));  // the last line does not end
    EXPECT_EQ(mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(PlyReader, RefusesWhatTheFileCannotHold) {
    EXPECT_NE(error_of(with_faces(1000000, "3 0 1 2\n"))
                  .find("the PLY header promises 1000000 of 'face', more than the file can hold"),
              std::string::npos);
    EXPECT_NE(error_of(with_faces(1, "4294967296 0\n")).find("invalid length"), std::string::npos);
    EXPECT_NE(error_of(with_faces(1, "-3 0 1 2\n")).find("invalid length"), std::string::npos);
    EXPECT_NE(error_of(with_faces(1, "2.5 0 1 2\n")).find("invalid length"), std::string::npos);
    EXPECT_NE(error_of(with_faces(1, "4000000000 0 1 2\n")).find("truncated"), std::string::npos);
}

TEST_F(PlyReader, VerticesNeedTheirPlaces) {
    for (const char* names : {"property float x\nproperty float y\n",
                              "property float x\nproperty float y\nproperty float y\n",
                              "property float x\nproperty float y\nproperty list int float z\n"})
        EXPECT_NE(error_of(std::string("ply\nformat ascii 1.0\nelement vertex 1\n") + names +
                           "end_header\n1 2 3\n")
                      .find("lack x, y or z"),
                  std::string::npos);
}

TEST_F(PlyReader, ThatIsNotThereIsAnIoError) {
    EXPECT_THROW(read_ply(folder_.path("none.ply"), warnings_), IoError);
}

}  // namespace
}  // namespace uw
