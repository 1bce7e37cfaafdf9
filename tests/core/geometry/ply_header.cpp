// ctest labels: unit
#include "core/geometry/ply_reader.h"

#include <gtest/gtest.h>

#include <sstream>

#include "core/base/error.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

PlyHeader ply_header(const std::string& text) {
    std::istringstream in(text);
    return read_ply_header(in, "m.ply");
}

std::string ply_header_error(const std::string& text) {
    return test::message_of<InputError>([&] { ply_header(text); });
}

TEST(PlyHeader, HasElementsAndTheirProperties) {
    std::istringstream in(
        "ply\nformat binary_big_endian 1.0\ncomment made by hand\nobj_info none\n\n"
        "element vertex 8\nproperty float x\nproperty double confidence\n"
        "element face 6\nproperty list uchar int vertex_indices\nend_header\nbody");
    const PlyHeader header = read_ply_header(in, "m.ply");
    EXPECT_EQ(header.encoding, PlyEncoding::big_endian);
    ASSERT_EQ(header.elements.size(), 2U);
    const PlyElement& vertex = header.elements[0];
    EXPECT_EQ(vertex.name, "vertex");
    EXPECT_EQ(vertex.count, 8U);
    ASSERT_EQ(vertex.properties.size(), 2U);
    EXPECT_EQ(vertex.properties[1].name, "confidence");
    EXPECT_EQ(vertex.properties[1].type, PlyType::float64);
    EXPECT_FALSE(vertex.properties[1].is_list);
    const PlyProperty& indices = header.elements[1].properties.at(0);
    EXPECT_TRUE(indices.is_list);
    EXPECT_EQ(indices.count_type, PlyType::uint8);
    EXPECT_EQ(indices.type, PlyType::int32);
    std::string rest;
    in >> rest;
    EXPECT_EQ(rest, "body");  // it is read up to its end, no further
}

TEST(PlyHeader, KnowsBothNamesOfEachType) {
    for (const auto& [old_name, new_name, type, bytes] :
         {std::tuple("char", "int8", PlyType::int8, 1U),
          {"uchar", "uint8", PlyType::uint8, 1U},
          {"short", "int16", PlyType::int16, 2U},
          {"ushort", "uint16", PlyType::uint16, 2U},
          {"int", "int32", PlyType::int32, 4U},
          {"uint", "uint32", PlyType::uint32, 4U},
          {"float", "float32", PlyType::float32, 4U},
          {"double", "float64", PlyType::float64, 8U}}) {
        for (const std::string name : {old_name, new_name}) {
            const PlyHeader header = ply_header("ply\nformat ascii 1.0\nelement e 1\nproperty " +
                                                name + " p\nend_header\n");
            EXPECT_EQ(header.elements.at(0).properties.at(0).type, type) << name;
        }
        EXPECT_EQ(size_of(type), bytes);
    }
}

TEST(PlyHeader, LinesMayEndAsOnWindows) {
    const PlyHeader header =
        ply_header("ply\r\nformat binary_little_endian 1.0\r\nelement vertex 1\r\nend_header\r\n");
    EXPECT_EQ(header.encoding, PlyEncoding::little_endian);
    EXPECT_EQ(header.elements.at(0).count, 1U);
}

TEST(PlyHeader, RefusesInOneLine) {
    const std::string start = "ply\nformat ascii 1.0\n";
    EXPECT_EQ(ply_header_error(""), "m.ply: not a PLY file (it does not start with 'ply')");
    EXPECT_EQ(ply_header_error("plyx\n"), "m.ply: not a PLY file (it does not start with 'ply')");
    EXPECT_NE(ply_header_error("ply\nformat utf8 1.0\n").find("unknown format 'utf8'"),
              std::string::npos);
    EXPECT_NE(ply_header_error(start + "element vertex 3").find("truncated"), std::string::npos);
    for (const char* count : {"", "-1", "3x", "1e3", "99999999999999999999"})
        EXPECT_NE(ply_header_error(start + "element vertex " + count + "\nend_header\n")
                      .find("element 'vertex' has no valid count"),
                  std::string::npos)
            << count;
    EXPECT_NE(
        ply_header_error(start + "element e 1\nproperty quad x\n").find("unknown type 'quad'"),
        std::string::npos);
    EXPECT_NE(ply_header_error(start + "property float x\n").find("misplaced or unknown line"),
              std::string::npos);
    EXPECT_NE(ply_header_error(start + "polygon 3\n").find("line 'polygon'"), std::string::npos);
    EXPECT_NE(ply_header_error("ply\nend_header\n").find("line 'end_header'"), std::string::npos);
}

TEST(PlyHeader, HasAnEnd) {
    EXPECT_NE(ply_header_error("ply\nformat ascii 1.0\n" + std::string(5000, 'c')).find("garbled"),
              std::string::npos);
    std::string endless = "ply\n";
    for (int i = 0; i < 20000; ++i) endless += "comment\n";
    EXPECT_NE(ply_header_error(endless).find("does not end"), std::string::npos);
}

}  // namespace
}  // namespace uw
