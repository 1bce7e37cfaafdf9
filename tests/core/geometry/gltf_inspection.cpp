// ctest labels: unit
#include "core/geometry/gltf_inspection.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

using GltfChanges = std::map<std::string, std::string>;
using IgnoredNames = std::vector<std::string>;

class GltfInspection : public testing::Test {
  protected:
    IgnoredNames inspect(const GltfChanges& changes, const GltfUse& use = {}) const {
        return inspect_gltf(GltfDocument(folder_.write("m.gltf", test::gltf_text(changes))), use);
    }
    void expect_refused(const GltfChanges& changes, const std::string& what) const {
        const std::string message = test::message_of<InputError>([&] { inspect(changes); });
        EXPECT_TRUE(message.starts_with(folder_.path("m.gltf").string() + ": ")) << message;
        EXPECT_NE(message.find(what), std::string::npos) << message;
    }
    /// The accessors of gltf_text with another one in the place of the positions.
    static GltfChanges positions(const std::string& accessor) {
        return {{"accessors", "[" + accessor + R"(,{"bufferView":1,"componentType":5123,"count":3,
                                      "type":"SCALAR"}])"}};
    }
    /// One primitive whose attributes are these.
    static GltfChanges attributes(const std::string& attributes) {
        return {{"meshes", R"([{"primitives":[{"attributes":{)" + attributes + "}}]}]"}};
    }
    test::MeshFolder folder_;
};

TEST_F(GltfInspection, FindsNothingToSayOfAPlainMesh) {
    EXPECT_EQ(inspect({}), IgnoredNames{});
}

TEST_F(GltfInspection, NamesWhatIsNotUsedSorted) {
    const GltfChanges all{
        {"cameras", R"([{"type":"orthographic"}])"},
        {"skins", "[{}]"},
        {"animations", "[{}]"},
        {"materials", R"([{"alphaMode":"BLEND","occlusionTexture":{}},{"occlusionTexture":{}}])"},
        {"extensionsUsed",
         R"(["KHR_lights_punctual","KHR_materials_ior","KHR_texture_transform","EXT_other"])"}};
    EXPECT_EQ(inspect(all), (IgnoredNames{"EXT_other", "KHR_materials_ior", "alpha blending",
                                          "metallic", "occlusion maps"}));
    EXPECT_EQ(inspect(all, {.pbr = true}),
              (IgnoredNames{"EXT_other", "alpha blending", "occlusion maps"}));
    EXPECT_EQ(inspect({{"materials", "[{}]"}}, {.diffuse_meant = true}), IgnoredNames{});
}

TEST_F(GltfInspection, MetallicIsTheDefaultOfASurface) {
    // glTF 2.0, 3.9.2: metallicFactor is 1 where it is left out.
    EXPECT_EQ(inspect({{"materials", "[{}]"}}), IgnoredNames{"metallic"});
    EXPECT_EQ(inspect({{"materials", R"([{"pbrMetallicRoughness":{"metallicFactor":0}}])"}}),
              IgnoredNames{});
}

TEST_F(GltfInspection, SomeExtensionsCannotBeDoneWithout) {
    expect_refused({{"extensionsRequired", R"(["KHR_draco_mesh_compression"])"}},
                   "needs the glTF extension KHR_draco_mesh_compression");
    EXPECT_EQ(inspect({{"extensionsRequired",
                        R"(["KHR_lights_punctual","KHR_texture_transform","KHR_materials_x"])"}}),
              IgnoredNames{});
}

TEST_F(GltfInspection, AccessorsLieInTheirViews) {
    const auto vec3 = [](const std::string& more) {
        return positions(R"({"bufferView":0,"componentType":5126,"type":"VEC3",)" + more + "}");
    };
    EXPECT_EQ(inspect(vec3(R"("count":3)")), IgnoredNames{});
    expect_refused(vec3(R"("count":4)"), "reaches past its bufferView");
    expect_refused(vec3(R"("count":3,"byteOffset":4)"), "reaches past its bufferView");
    expect_refused(vec3(R"("count":4000000000)"), "larger count than its file can hold");
    expect_refused(vec3(R"("count":3,"sparse":{"count":4,"indices":{},"values":{}})"),
                   "more sparse values than values");
    expect_refused(positions(R"({"bufferView":9,"componentType":5126,"count":3,"type":"VEC3"})"),
                   "'bufferView' refers to an item that does not exist");
    expect_refused(positions(R"({"bufferView":0,"componentType":5124,"count":3,"type":"VEC3"})"),
                   "invalid type");
}

TEST_F(GltfInspection, ViewsLieInTheirBuffers) {
    const auto view = [](const std::string& rest) {
        return GltfChanges{{"bufferViews", R"([{"buffer":0,)" + rest + "}]"}};
    };
    expect_refused(view(R"("byteLength":1000)"), "reaches past its buffer");
    expect_refused(view(R"("byteOffset":100,"byteLength":36)"), "reaches past its buffer");
    expect_refused(view(R"("byteOffset":18446744073709551600,"byteLength":36)"),
                   "reaches past its buffer");
    expect_refused({{"bufferViews", R"([{"buffer":0,"byteLength":36,"byteStride":8},
                                        {"buffer":0,"byteOffset":36,"byteLength":6}])"}},
                   "reaches past its bufferView");
}

TEST_F(GltfInspection, BuffersAreFilesOfTheirLength) {
    expect_refused({{"buffers", R"([{"byteLength":100000,"uri":"data:;base64,AAAA"}])"}},
                   "longer than its file");
    folder_.write("b.bin", std::string(50, 'x'));
    expect_refused({{"buffers", R"([{"byteLength":116,"uri":"b.bin"}])"}}, "longer than its file");
    const std::string message = test::message_of<IoError>([&] {
        inspect({{"buffers", R"([{"byteLength":116,"uri":"none.bin"}])"}});
    });
    EXPECT_NE(message.find("its buffer none.bin is missing"), std::string::npos) << message;
}

// The system takes a name up to its first NUL, and so do messages.
TEST_F(GltfInspection, NamesWithNulAreShownWhole) {
    folder_.write("there.bin", std::string(1000, '\0'));
    for (const char* uri : {R"(there.bin\u0000.png)", "there.bin%00.png"}) {
        const std::string message = test::message_of<IoError>([&] {
            inspect({{"buffers", std::string(R"([{"byteLength":44,"uri":")") + uri + "\"}]"}});
        });
        EXPECT_TRUE(message.ends_with(" is missing; put it beside the glTF file")) << message;
        EXPECT_NE(message.find("there.bin"), std::string::npos) << message;
        EXPECT_EQ(message.find('\0'), std::string::npos);
    }
    expect_refused({{"extensionsRequired", R"(["KHR_\u0000_draco"])"}},
                   "needs the glTF extension KHR_?_draco, which is not supported; export without");
}

TEST_F(GltfInspection, AttributesAreOfTheirKind) {
    expect_refused(attributes(R"("NORMAL":0)"), "has no POSITION");
    expect_refused(attributes(R"("POSITION":9)"), "refers to an accessor that does not exist");
    expect_refused(attributes(R"("POSITION":3)"), "POSITION has the invalid type 'VEC4'");
    expect_refused(attributes(R"("POSITION":1)"), "POSITION is quantised");
    expect_refused(attributes(R"("POSITION":0,"NORMAL":2)"), "NORMAL has the invalid type");
    expect_refused(attributes(R"("POSITION":0,"TEXCOORD_0":0)"), "TEXCOORD_0 has the invalid");
    expect_refused(attributes(R"("POSITION":0,"COLOR_0":2)"), "COLOR_0 has the invalid type");
    expect_refused(attributes(R"("POSITION":0,"TANGENT":0)"), "TANGENT has the invalid type");
    EXPECT_EQ(inspect(attributes(R"("POSITION":0,"NORMAL":0,"TEXCOORD_0":2,"TANGENT":3)")),
              IgnoredNames{});
}

TEST_F(GltfInspection, VerticesHaveAllOfTheirAttributes) {
    GltfChanges changes = attributes(R"("POSITION":0,"TEXCOORD_0":1)");
    changes["accessors"] = R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
                               {"bufferView":2,"componentType":5126,"count":2,"type":"VEC2"}])";
    expect_refused(changes, "TEXCOORD_0 does not have the same count as POSITION");
    expect_refused(positions(R"({"componentType":5126,"count":3,"type":"VEC3"})"),
                   "POSITION has no data");
}

TEST_F(GltfInspection, PrimitivesMayBeNoTriangles) {
    EXPECT_EQ(inspect({{"meshes", R"([{"primitives":[{"attributes":{"POSITION":0},"mode":1}]}])"}}),
              IgnoredNames{"points and lines"});
    expect_refused({{"meshes", R"([{"primitives":[{"attributes":{"POSITION":0},"indices":0}]}])"}},
                   "indices are not whole numbers");
}

// Accessor 0 is of three numbers per vertex, 3 of four.
TEST_F(GltfInspection, MorphTargetsFitTheirPrimitives) {
    const auto meshes = [](const std::string& primitives) {
        return GltfChanges{{"meshes", R"([{"primitives":[)" + primitives + "]}]"}};
    };
    const auto with = [](const std::string& targets) {
        return R"({"attributes":{"POSITION":0},"targets":[)" + targets + "]}";
    };
    EXPECT_EQ(inspect(meshes(with(R"({"POSITION":0,"TANGENT":0},{"NORMAL":0})"))), IgnoredNames{});
    expect_refused(meshes(with(R"({"TANGENT":3})")), "TANGENT has the invalid type 'VEC4'");
    expect_refused(meshes(with(R"({"POSITION":9})")), "an accessor that does not exist");
    expect_refused(meshes(with("{}") + "," + with("{},{}")), "the same number of morph targets");
}

}  // namespace
}  // namespace uw
