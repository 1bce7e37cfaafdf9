// ctest labels: unit
#include "core/geometry/gltf_document.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

constexpr auto k_min_gltf = R"({"asset":{"version":"2.0"},"extras":7})";

class GltfJson : public testing::Test {
  protected:
    nlohmann::json load(const std::string& bytes) const {
        return load_gltf_json(folder_.write("m.gltf", bytes));
    }
    void expect_refused(const std::string& bytes, const std::string& what) const {
        const std::string message = test::message_of<InputError>([&] { load(bytes); });
        EXPECT_EQ(message, folder_.path("m.gltf").string() + ": " + what);
    }
    test::MeshFolder folder_;
};

TEST_F(GltfJson, IsTheTextOrTheFirstChunk) {
    EXPECT_EQ(load(k_min_gltf).at("extras"), 7);
    EXPECT_EQ(load(test::glb_bytes(k_min_gltf)).at("extras"), 7);
    EXPECT_EQ(load(test::glb_bytes(k_min_gltf, "1234")).at("extras"), 7);
}

TEST_F(GltfJson, OfOtherVersionsIsRefused) {
    expect_refused("{}", "not a glTF file (it has no 'asset')");
    expect_refused("[]", "not a glTF file (it has no 'asset')");
    expect_refused(R"({"asset":{}})", "not glTF 2; export it as glTF 2.0");
    expect_refused(R"({"asset":{"version":"1.0"}})", "not glTF 2; export it as glTF 2.0");
    std::string glb = test::glb_bytes(k_min_gltf);
    glb[4] = 1;
    expect_refused(glb, "not a GLB file of version 2; export it as glTF 2.0");
    expect_refused("glTF\x02", "not a GLB file of version 2; export it as glTF 2.0");
}

TEST_F(GltfJson, ThatIsCutOffIsRefused) {
    const std::string glb = test::glb_bytes(k_min_gltf);
    expect_refused(glb.substr(0, glb.size() - 1),
                   "the GLB file is truncated; export the mesh again");
    std::string forged = glb;
    forged[15] = '\x7f';  // the chunk's length
    expect_refused(forged, "the GLB file is truncated; export the mesh again");
    EXPECT_THROW(load(std::string(k_min_gltf).substr(0, 20)), nlohmann::json::exception);
}

TEST_F(GltfJson, MayBeNestedAHundredDeep) {
    const auto nested = [](int depth) {
        return R"({"asset":{"version":"2.0"},"extras":)" + std::string(depth, '[') +
               std::string(depth, ']') + "}";
    };
    EXPECT_NO_THROW(load(nested(99)));
    expect_refused(nested(100), "the glTF is nested too deeply");
    expect_refused(nested(1000000), "the glTF is nested too deeply");
    // Brackets in a text are none.
    EXPECT_NO_THROW(
        load(R"({"asset":{"version":"2.0"},"extras":"\")" + std::string(500, '[') + "\"}"));
}

TEST_F(GltfJson, ThatIsNoFileCannotBeOpened) {
    EXPECT_THROW(load_gltf_json(folder_.path("none.gltf")), IoError);
    EXPECT_THROW(load_gltf_json(folder_.path("")), IoError);
}

// Long data URIs bypass the parser: what it returns is the same as by itself.
TEST_F(GltfJson, LongDataUrisAreWhole) {
    const std::string first = "data:;base64," + std::string(100000, 'A'),
                      second = "data:;base64," + std::string(200000, 'B');
    const std::string json = R"({"asset":{"version":"2.0"},
        "images":[{"name":"\\\"[{","uri":")" +
                             second + R"("},{"uri":"a.png"}, {}, 5],
        "buffers":[{"uri":"data:;base64,AAAA"},{"byteLength":3,"uri":")" +
                             first + R"("}],"last":"\\"})";
    EXPECT_EQ(load(json), nlohmann::json::parse(json));
    EXPECT_EQ(gltf_uri(load(json)["buffers"][1]), first);
    EXPECT_EQ(gltf_uri(load(json)["images"][2]), "");
    EXPECT_THROW(gltf_uri(load(json)["images"][3]), nlohmann::json::exception);
    EXPECT_THROW(gltf_uri(nlohmann::json::parse(R"({"uri":5})")), nlohmann::json::exception);
    // What only looks like one, or like what stands for one in between, is left to it.
    std::string escaped = json, forged = json;
    escaped.insert(escaped.find("data:;base64,BB") + 13, R"(\u0041)");
    EXPECT_EQ(load(escaped), nlohmann::json::parse(escaped));
    forged.replace(forged.find("a.png"), 5, "data:left out by uwvdb 0");
    EXPECT_EQ(load(forged), nlohmann::json::parse(forged));
    EXPECT_THROW(load(json.substr(0, json.size() - 200000)), nlohmann::json::exception);
    EXPECT_THROW(load(json.substr(0, json.size() - 4)), nlohmann::json::exception);
}

}  // namespace
}  // namespace uw
