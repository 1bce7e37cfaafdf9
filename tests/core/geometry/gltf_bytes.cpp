// ctest labels: unit
#include "core/geometry/gltf_document.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

using test::base64;
using test::bytes_of;

class GltfBytesTest : public testing::Test {
  protected:
    /// A document whose only buffer holds `bytes` and whose view 0 is all of it, with more views.
    GltfDocument document(const std::string& bytes, const std::string& more_views = "",
                          const std::string& uri = "") const {
        const std::string source =
            uri.empty() ? "data:application/octet-stream;base64," + base64(bytes) : uri;
        return GltfDocument(
            folder_.write("m.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":)" +
                                        std::to_string(bytes.size()) + R"(,"uri":")" + source +
                                        R"("}],"bufferViews":[{"buffer":0,"byteLength":)" +
                                        std::to_string(bytes.size()) + "}" + more_views + "]}"));
    }
    static std::string text(std::span<const std::byte> bytes) {
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
    test::MeshFolder folder_;
};

nlohmann::json gltf_accessor(const char* text) {
    return nlohmann::json::parse(text);
}

TEST_F(GltfBytesTest, BuffersAreInTheTextBesideTheFileOrInIt) {
    const nlohmann::json first = gltf_accessor(R"({"bufferView":0})");
    const std::string content = "seven b";
    const GltfDocument inside = document(content);
    EXPECT_EQ(text(GltfBytes(inside).view(first, "bufferView")), content);
    folder_.write("a file.bin", content + " and more");
    const GltfDocument beside = document(content, "", "a%20file.bin");
    EXPECT_EQ(text(GltfBytes(beside).view(first, "bufferView")), content);
    const GltfDocument glb(folder_.write(
        "m.glb", test::glb_bytes(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":7}],
                                    "bufferViews":[{"buffer":0,"byteOffset":2,"byteLength":4}]})",
                                 content)));
    EXPECT_EQ(text(GltfBytes(glb).view(first, "bufferView")), "ven ");
}

TEST_F(GltfBytesTest, Base64OfAnyLength) {
    const GltfDocument any = document("x");
    std::string bytes;
    for (int length = 0; length < 20; ++length) {
        const auto decoded = decode_data_uri(any, "data:;base64," + base64(bytes));
        EXPECT_EQ(text(decoded), bytes);
        bytes.push_back(static_cast<char>(length * 37 + 200));
    }
    EXPECT_THROW(decode_data_uri(any, "data:text/plain,hello"), InputError);
    EXPECT_EQ(text(decode_data_uri(any, "data:;base64,YQ")), "a");
    EXPECT_EQ(text(decode_data_uri(any, "data:;base64,YWI=ignored*")), "ab");
    for (const char* digits : {"ab*d", "*bcd", "abcdef*", "abcd*", "ab\xff\xff", "abcdabc\x80"})
        EXPECT_THROW(decode_data_uri(any, std::string("data:;base64,") + digits), InputError)
            << digits;
}

TEST_F(GltfBytesTest, NumbersOfAllTypes) {
    // Normalised as glTF 2.0, 3.11 has it: c / 127, c / 255, c / 32767, c / 65535, signed ones not
    // below -1.
    const GltfDocument bytes = document(std::string("\x7f\x80\xff\x33", 4));
    const auto at = [&](const char* json) {
        return GltfBytes(bytes).floats(gltf_accessor(json), 1);
    };
    EXPECT_EQ(at(R"({"bufferView":0,"count":4,"type":"SCALAR","componentType":5120})"),
              (std::vector<float>{127, -128, -1, 51}));
    EXPECT_EQ(
        at(R"({"bufferView":0,"count":3,"type":"SCALAR","componentType":5120,"normalized":true})"),
        (std::vector<float>{1, -1, -1 / 127.0F}));
    EXPECT_EQ(at(R"({"bufferView":0,"count":4,"type":"SCALAR","componentType":5121})"),
              (std::vector<float>{127, 128, 255, 51}));
    EXPECT_EQ(at(R"({"bufferView":0,"byteOffset":2,"count":2,"type":"SCALAR","componentType":5121,
                     "normalized":true})"),
              (std::vector<float>{1, 0.2F}));
    const GltfDocument shorts = document(bytes_of<std::int16_t>({32767, -32768, -32767}));
    EXPECT_EQ(GltfBytes(shorts).floats(
                  gltf_accessor(
                      R"({"bufferView":0,"count":3,"type":"SCALAR","componentType":5122,
                          "normalized":true})"),
                  1),
              (std::vector<float>{1, -1, -1}));
}

TEST_F(GltfBytesTest, ElementsMayBeInterleavedAndOfAnotherWidth) {
    const GltfDocument mixed = document(bytes_of<float>({9, 1, 2, 8, 3, 4}),
                                        R"(,{"buffer":0,"byteLength":24,"byteStride":12})");
    const nlohmann::json pairs = gltf_accessor(
        R"({"bufferView":1,"byteOffset":4,"count":2,"type":"VEC2","componentType":5126})");
    EXPECT_EQ(GltfBytes(mixed).floats(pairs, 2), (std::vector<float>{1, 2, 3, 4}));
    EXPECT_EQ(GltfBytes(mixed).floats(pairs, 1), (std::vector<float>{1, 3}));
    EXPECT_EQ(GltfBytes(mixed).floats(pairs, 3), (std::vector<float>{1, 2, 0, 3, 4, 0}));
}

TEST_F(GltfBytesTest, SparseValuesReplaceOthers) {
    const GltfDocument sparse =
        document(bytes_of<float>({1, 2, 3, 70, 80}) + std::string("\x02\x00", 2),
                 R"(,{"buffer":0,"byteOffset":12,"byteLength":8})"
                 R"(,{"buffer":0,"byteOffset":20,"byteLength":2})");
    const auto patched = [&](const char* view, int count) {
        return GltfBytes(sparse).floats(
            gltf_accessor((std::string("{") + view + R"("count":)" + std::to_string(count) +
                           R"(,"type":"SCALAR","componentType":5126,"sparse":{"count":2,
                            "indices":{"bufferView":2,"componentType":5121},
                            "values":{"bufferView":1}}})")
                              .c_str()),
            1);
    };
    EXPECT_EQ(patched(R"("bufferView":0,)", 3), (std::vector<float>{80, 2, 70}));
    EXPECT_EQ(patched("", 4), (std::vector<float>{80, 0, 70, 0}));  // of zeros
    EXPECT_THROW(patched("", 2), InputError);                       // there is no element 2
}

TEST_F(GltfBytesTest, IndicesOfAllTypes) {
    const GltfDocument bytes = document(std::string("\x01\x02\xff\xff\x00\x00\x00\x80", 8));
    const auto at = [&](const char* json) { return GltfBytes(bytes).indices(gltf_accessor(json)); };
    using Indices = std::vector<std::uint32_t>;
    EXPECT_EQ(at(R"({"bufferView":0,"count":4,"componentType":5121})"), (Indices{1, 2, 255, 255}));
    EXPECT_EQ(at(R"({"bufferView":0,"count":2,"componentType":5123})"), (Indices{513, 65535}));
    EXPECT_EQ(at(R"({"bufferView":0,"byteOffset":4,"count":1,"componentType":5125})"),
              (Indices{2147483648U}));
    EXPECT_EQ(at(R"({"count":2,"componentType":5123})"), (Indices{0, 0}));
    EXPECT_THROW(at(R"({"count":2,"componentType":5123,"sparse":{}})"), InputError);
}

TEST_F(GltfBytesTest, WhatIsCutOffIsRefused) {
    const nlohmann::json past = gltf_accessor(R"({"bufferView":1})");
    for (const char* view :
         {R"(,{"buffer":0,"byteOffset":5,"byteLength":4})", R"(,{"buffer":0,"byteLength":9})",
          R"(,{"buffer":0,"byteOffset":18446744073709551615,"byteLength":4})",
          R"(,{"buffer":1,"byteLength":4})"}) {
        const GltfDocument broken = document("8 bytes!", view);
        EXPECT_THROW(GltfBytes(broken).view(past, "bufferView"), InputError) << view;
    }
    folder_.write("short.bin", "7 bytes");
    const nlohmann::json first = gltf_accessor(R"({"bufferView":0})");
    const GltfDocument cut = document("8 bytes!", "", "short.bin");
    const std::string message =
        test::message_of<IoError>([&] { GltfBytes(cut).view(first, "bufferView"); });
    EXPECT_NE(message.find("the file is truncated"), std::string::npos) << message;
    const GltfDocument short_text = document("8 bytes!", "", "data:;base64,AAAA");
    EXPECT_THROW(GltfBytes(short_text).view(first, "bufferView"), InputError);
    const GltfDocument no_chunk(folder_.write(
        "m.glb", test::glb_bytes(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":7}],
                                    "bufferViews":[{"buffer":0,"byteLength":7}]})")));
    EXPECT_THROW(GltfBytes(no_chunk).view(first, "bufferView"), InputError);
}

TEST(GltfComponents, SizesOfTheSpecification) {
    // glTF 2.0, sections 3.6.2.2 and 3.6.2.3.
    for (const auto& [type, count] : {std::pair{"SCALAR", 1U},
                                      {"VEC2", 2U},
                                      {"VEC3", 3U},
                                      {"VEC4", 4U},
                                      {"MAT2", 4U},
                                      {"MAT3", 9U},
                                      {"MAT4", 16U},
                                      {"VEC5", 0U},
                                      {"", 0U}})
        EXPECT_EQ(gltf_component_count(type), count) << type;
    for (const auto& [type, size] : {std::pair{5120U, 1U},
                                     {5121U, 1U},
                                     {5122U, 2U},
                                     {5123U, 2U},
                                     {5125U, 4U},
                                     {5126U, 4U},
                                     {5124U, 0U},
                                     {0U, 0U}})
        EXPECT_EQ(gltf_component_size(type), size) << type;
}

}  // namespace
}  // namespace uw
