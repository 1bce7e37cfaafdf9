// ctest labels: unit analytic
#include "core/geometry/gltf_nodes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

class GltfNodes : public testing::Test {
  protected:
    /// The nodes of a file with this list of them and, if any, this key with its scenes.
    std::vector<GltfNode> nodes(const std::string& list, const std::string& scenes = "") {
        document_.emplace(folder_.write("m.gltf", R"({"asset":{"version":"2.0"},"nodes":)" + list +
                                                      (scenes.empty() ? "" : "," + scenes) + "}"));
        return gltf_nodes(*document_);
    }
    std::vector<std::size_t> indices(const std::string& list, const std::string& scenes = "") {
        std::vector<std::size_t> result;
        for (const GltfNode& node : nodes(list, scenes)) result.push_back(node.index);
        return result;
    }
    void expect_refused(const std::string& list, const std::string& what,
                        const std::string& scenes = "") {
        const std::string message = test::message_of<InputError>([&] { nodes(list, scenes); });
        EXPECT_NE(message.find(what), std::string::npos) << message;
    }
    static void expect_at(const Point3& a, const Point3& b) {
        EXPECT_LT(distance(a, b), 1e-12) << a.x << " " << a.y << " " << a.z;
    }

    test::MeshFolder folder_;
    std::optional<GltfDocument> document_;
};

using NodeOrder = std::vector<std::size_t>;

TEST_F(GltfNodes, AreThoseOfTheSceneParentsFirst) {
    const std::string tree = R"([{"children":[2,1]},{},{"children":[3]},{},{"children":[5]},{}])";
    EXPECT_EQ(indices(tree, R"("scene":1,"scenes":[{"nodes":[4]},{"nodes":[0]}])"),
              (NodeOrder{0, 2, 3, 1}));
    EXPECT_EQ(indices(tree, R"("scenes":[{"nodes":[4,0]},{"nodes":[0]}])"),
              (NodeOrder{4, 5, 0, 2, 3, 1}));
    EXPECT_EQ(indices(tree), (NodeOrder{0, 2, 3, 1, 4, 5}));  // without scenes all
    EXPECT_TRUE(indices(tree, R"("scenes":[{}])").empty());
}

TEST_F(GltfNodes, ScaleThenTurnThenMove) {
    // 90 degrees about z takes x to y.
    const double half = std::sqrt(0.5);
    const auto node = nodes(R"([{"translation":[10,20,30],"scale":[2,3,4],"rotation":[0,0,)" +
                            std::to_string(half) + "," + std::to_string(half) + "]}]");
    expect_at(node.at(0).file_from_node * Point3{1, 0, 0}, {10, 22, 30});
    expect_at(node.at(0).file_from_node * Point3{0, 1, 0}, {7, 20, 30});
    expect_at(node.at(0).file_from_node * Point3{0, 0, 1}, {10, 20, 34});
}

TEST_F(GltfNodes, QuaternionsMayHaveAnyLength) {
    // A third of a turn about the diagonal takes x to y, y to z, z to x.
    const auto node = nodes(R"([{"rotation":[7,7,7,7]}])");
    expect_at(node.at(0).file_from_node * Point3{1, 2, 3}, {3, 1, 2});
}

TEST_F(GltfNodes, MatricesStandColumnByColumn) {
    const auto node = nodes(R"([{"matrix":[1,2,3,0, 4,5,6,0, 7,8,10,0, 11,12,13,1]}])");
    expect_at(node.at(0).file_from_node * Point3{0, 0, 0}, {11, 12, 13});
    expect_at(node.at(0).file_from_node * Point3{1, 0, 0}, {12, 14, 16});
    expect_at(node.at(0).file_from_node * Point3{0, 0, 1}, {18, 20, 23});
}

TEST_F(GltfNodes, ChildrenMoveWithTheirParents) {
    const auto chain =
        nodes(R"([{"children":[1],"scale":[2,2,2]},{"children":[2],"translation":[1,0,0]},)"
              R"({"translation":[0,1,0]}])");
    expect_at(chain.at(2).file_from_node * Point3{0, 0, 0}, {2, 2, 0});
    EXPECT_EQ(chain.at(2).json, &document_->list("nodes")[2]);
}

TEST_F(GltfNodes, AreAStrictTree) {
    expect_refused(R"([{"children":[0]}])", "form a cycle");
    expect_refused(R"([{"children":[1]},{"children":[0]}])", "form a cycle");
    expect_refused(R"([{"children":[2]},{"children":[2]},{}])", "two parents");
    expect_refused(R"([{"children":[1,1]},{}])", "two parents");
    expect_refused(R"([{"children":[5]}])", "refers to a node that does not exist");
    expect_refused(R"([{"children":[-1]}])", "refers to a node that does not exist");
    const std::string pair = R"([{"children":[1]},{}])";
    expect_refused(pair, "not a root, or lists one twice", R"("scenes":[{"nodes":[1]}])");
    expect_refused(pair, "not a root, or lists one twice", R"("scenes":[{"nodes":[0,0]}])");
    expect_refused(pair, "refers to a node that does not exist", R"("scenes":[{"nodes":[2]}])");
    expect_refused(pair, "'scene' refers to an item that does not exist",
                   R"("scene":1,"scenes":[{}])");
}

TEST_F(GltfNodes, MayBeNested256Deep) {
    const auto chain = [](int links) {
        std::string list = "[";
        for (int i = 1; i <= links; ++i) list += R"({"children":[)" + std::to_string(i) + "]},";
        return list + "{}]";
    };
    EXPECT_EQ(indices(chain(256)).size(), 257U);
    expect_refused(chain(257), "nested more than 256 deep");
}

TEST_F(GltfNodes, HaveTheRightNumbers) {
    expect_refused(R"([{"translation":[1,2]}])", "'translation' does not have 3 numbers");
    expect_refused(R"([{"rotation":[0,0,1]}])", "'rotation' does not have 4 numbers");
    expect_refused(R"([{"rotation":[0,0,0,0]}])", "rotation is zero");
    expect_refused(R"([{"matrix":[1]}])", "'matrix' does not have 16 numbers");
}

}  // namespace
}  // namespace uw
