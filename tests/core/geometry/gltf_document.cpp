// ctest labels: unit
#include "core/geometry/gltf_document.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

class GltfDocumentTest : public testing::Test {
  protected:
    GltfDocumentTest()
        : document_(folder_.write("m.gltf", R"({"asset":{"version":"2.0"},
              "nodes":[{"mesh":1},{"mesh":2},{"mesh":-1},{"mesh":0.5},{"name":"none"}],
              "meshes":[{"name":"a"},{"name":"b"}],
              "scenes":{"0":{}},
              "extensions":{"EXT_x":{"key":5},"EXT_y":[]}})")) {}

    template <class Action>
    void expect_refused(const Action& action, const std::string& what) const {
        EXPECT_EQ(test::message_of<InputError>(action),
                  folder_.path("m.gltf").string() + ": " + what);
    }
    const nlohmann::json& node(std::size_t i) const { return document_.list("nodes")[i]; }

    test::MeshFolder folder_;
    GltfDocument document_;
};

TEST_F(GltfDocumentTest, ListsAndObjectsMayBeLeftOut) {
    EXPECT_EQ(document_.list("nodes").size(), 5U);
    EXPECT_TRUE(document_.list("lights").empty());
    EXPECT_TRUE(document_.object(document_.root(), "lights").empty());
    EXPECT_TRUE(document_.list(nlohmann::json(5), "nodes").empty());
}

TEST_F(GltfDocumentTest, ListsAndObjectsOfAnotherKindAreRefused) {
    expect_refused([&] { document_.list("scenes"); }, "glTF 'scenes' is not a list");
    expect_refused([&] { document_.object(document_.root(), "nodes"); },
                   "glTF 'nodes' is not an object");
    expect_refused([&] { document_.extension(document_.root(), "EXT_y"); },
                   "glTF 'EXT_y' is not an object");
}

TEST_F(GltfDocumentTest, ExtensionsMayBeLeftOut) {
    EXPECT_EQ(document_.whole_number(document_.extension(document_.root(), "EXT_x"), "key", 0), 5U);
    EXPECT_TRUE(document_.extension(document_.root(), "EXT_z").empty());
    EXPECT_TRUE(document_.extension(node(0), "EXT_x").empty());
}

TEST_F(GltfDocumentTest, WholeNumbersAreNotNegativeOrBroken) {
    EXPECT_EQ(document_.whole_number(node(0), "mesh", 9), 1U);
    EXPECT_EQ(document_.whole_number(node(4), "mesh", 9), 9U);
    for (const std::size_t i : {2U, 3U})
        expect_refused([&] { document_.whole_number(node(i), "mesh", 9); },
                       "glTF 'mesh' is not a whole number");
    expect_refused([&] { document_.whole_number(node(4), "name", 9); },
                   "glTF 'name' is not a whole number");
}

TEST_F(GltfDocumentTest, ElementsAreThere) {
    EXPECT_EQ(document_.element("meshes", node(0), "mesh").at("name"), "b");
    for (const std::size_t i : {1U, 4U})
        expect_refused([&] { document_.element("meshes", node(i), "mesh"); },
                       "glTF 'mesh' refers to an item that does not exist");
}

}  // namespace
}  // namespace uw
