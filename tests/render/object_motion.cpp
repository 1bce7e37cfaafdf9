// ctest labels: unit
#include "render/view_matcher.h"

#include <gtest/gtest.h>

#include "render/image_scene.h"
#include "render/renderer.h"
#include "render/scene_loading.h"
#include "tests/support/meshes/vehicle_gltf.h"
#include "tests/support/scene_folder.h"

namespace uw::test {
namespace {

class ObjectMotion : public testing::Test {
  protected:
    SceneDesc load(const std::string& geometry) const {
        return load_scene(folder_.write("scene.yaml",
                                        "uwvdb: 1\ncamera: {resolution: [8, 6], intrinsics: {fx: "
                                        "9}}\ngeometry:\n" +
                                            geometry),
                          {});
    }
    ObjectMotions motions(const SceneDesc& scene, int from, int to) {
        const ImageScene now = scene_of_image(scene, {from}), then = scene_of_image(scene, {to});
        Renderer renderer;
        renderer.set_scene(now);
        warnings_.clear();
        return object_motions(now.desc(), then.desc(), renderer.assemble().surfaces->names(),
                              warnings_);
    }
    SceneFolder folder_;
    std::vector<std::string> warnings_;
};

TEST_F(ObjectMotion, OfStillScenesIsNone) {
    const SceneDesc scene = load("  - {type: box, min: [0, 0, 1], max: [1, 1, 2]}\n");
    EXPECT_TRUE(motions(scene, 0, 1).empty());
}

// By the ids of the objects: a file's node, then a shape that moves, then one that stands.
TEST_F(ObjectMotion, IsThatOfEachObject) {
    folder_.write("vehicle.gltf", vehicle_gltf());
    const SceneDesc scene = load(
        "  - {file: vehicle.gltf}\n"
        "  - {type: box, min: [0, 0, 1], max: [1, 1, 2], trajectory: {interpolation: linear, "
        "keyframes: [{time: 0}, {time: 1, position: [0, 0, 5]}]}}\n"
        "  - {type: sphere, center: [0, 0, 0], radius: 1}\n");
    const ObjectMotions all = motions(scene, 0, 10);
    ASSERT_EQ(all.size(), 3U);
    EXPECT_LT(distance(all[1]->map * Point3{0.5, 0.5, 1}, {0.5, 0.5, 3}), 1e-14);
    EXPECT_EQ(all[2]->map, Affine());
    // The crate goes towards (1.5, 0.5, -3.5) from (1, 0, -3), in half a second.
    const Vector3 way = all[0]->map * Point3{1, 0, -3} - Point3{1, 0, -3};
    EXPECT_GT(way.x, 0.2);
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(ObjectMotion, OfFilesThatAreOneForEachFrameIsUnknown) {
    folder_.write("a_0000.gltf", vehicle_gltf());
    folder_.write("a_0001.gltf", vehicle_gltf());
    const SceneDesc scene = load(
        "  - {file: 'a_####.gltf'}\n"
        "  - {type: plane, point: [0, 0, -6], normal: [0, 0, 1]}\n");
    const ObjectMotions all = motions(scene, 0, 1);
    ASSERT_EQ(all.size(), 2U);
    EXPECT_FALSE(all[0]);
    ASSERT_TRUE(all[1]);
    EXPECT_EQ(all[1]->map, Affine());
    ASSERT_EQ(warnings_.size(), 1U);
    EXPECT_NE(warnings_[0].find("geometry[0]: no flow: its files are one for each frame"),
              std::string::npos)
        << warnings_[0];
    EXPECT_TRUE(has_frame(scene, 1));
    EXPECT_FALSE(has_frame(scene, 2));
    EXPECT_FALSE(has_frame(scene, -1));
}

// What is scaled to nothing shows no points, and comes from none.
TEST_F(ObjectMotion, OfNodesWithoutASizeIsUnknown) {
    std::string text = vehicle_gltf();
    const std::string crate = R"("name":"Crate","translation")";
    ASSERT_NE(text.find(crate), std::string::npos);
    text.replace(text.find(crate), crate.size(), R"("scale":[0,0,0],)" + crate);
    const std::string channel = R"({"sampler":2,"target":{"node":3,"path":"scale"}})";
    ASSERT_NE(text.find(channel), std::string::npos);
    text.replace(text.find("," + channel), channel.size() + 1, "");
    // Another that has one, or there would be no triangle.
    const std::string shown = R"("nodes":[2,3])";
    ASSERT_NE(text.find(shown), std::string::npos);
    text.replace(text.find(shown), shown.size(), R"("nodes":[2,3,4])");
    text.replace(text.find(R"(],"cameras")"), 1, R"(,{"mesh":0,"name":"whole"}])");
    folder_.write("flat.gltf", text);
    const SceneDesc scene = load(
        "  - {file: flat.gltf}\n"
        "  - {type: sphere, center: [0, 0, 0], radius: 1}\n");
    const ObjectMotions all = motions(scene, 0, 5);
    ASSERT_EQ(all.size(), 3U);
    EXPECT_FALSE(all[0]);
    EXPECT_TRUE(all[1]);
    EXPECT_TRUE(all[2]);
}

}  // namespace
}  // namespace uw::test
