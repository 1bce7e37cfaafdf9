// ctest labels: unit
#include "render/image_scene.h"

#include <gtest/gtest.h>

#include <type_traits>

#include "core/base/error.h"
#include "render/scene_loading.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/scene_folder.h"

namespace uw::test {
namespace {

// Making the scene of an image is what imports. None is made from another, nor from a description
// that others still use, but by a copy that one sees.
static_assert(std::is_convertible_v<SceneDesc, ImageScene>);
static_assert(!std::is_constructible_v<ImageScene, const SceneDesc&>);
static_assert(!std::is_constructible_v<ImageScene, SceneDesc&>);

constexpr const char* k_world =
    "volumes: [{file: smoke_####.vdb, velocity: {grid: v, file: wind_####.vdb}, grids: {density: "
    "{large: 1}}}, {file: still.vdb, grids: {density: {large: 1}}}]\n"
    "geometry: [{file: 'ship_####.gltf', lamps: all}]\n"
    "render: {shutter: 0.01}\n";

class OfAnImage : public testing::Test {
  protected:
    OfAnImage() {
        folder_.write("still.vdb", "");
        for (const char* name : {"smoke_0003.vdb", "wind_0003.vdb"}) folder_.write(name, "");
        folder_.write(
            "ship_0003.gltf",
            gltf_text(
                {{"scenes", R"([{"nodes":[0,1]}])"},
                 {"nodes",
                  R"([{"mesh":0},{"name":"Bulb","extensions":{"KHR_lights_punctual":{"light":0}}}])"},
                 {"extensions", R"({"KHR_lights_punctual":{"lights":[{"type":"point"}]}})"}}));
    }
    SceneDesc load(const std::string& cameras) const {
        return load_scene(folder_.write("scene.yaml", "uwvdb: 1\n" + cameras + k_world), {});
    }
    SceneDesc load() const {
        return load("camera: {resolution: [4, 3], intrinsics: {fov_x: 60}}\n");
    }

    SceneFolder folder_;
};

TEST_F(OfAnImage, FramesHaveTheirFiles) {
    const SceneDesc all = load();
    const ImageScene image = scene_of_image(all, {3});
    const SceneDesc& third = image.desc();
    EXPECT_EQ(third.volumes[0].file, folder_.path() / "smoke_0003.vdb");
    EXPECT_EQ(third.volumes[0].motion->file, folder_.path() / "wind_0003.vdb");
    EXPECT_EQ(third.volumes[1].file, folder_.path() / "still.vdb");
    EXPECT_EQ(third.geometry[0].file, folder_.path() / "ship_0003.gltf");
    EXPECT_FALSE(third.volumes[0].is_sequence || third.volumes[0].motion->is_sequence ||
                 third.geometry[0].is_sequence);
    EXPECT_TRUE(image.whole().volumes[0].is_sequence);
    EXPECT_EQ(image.choice().frame, 3);
    EXPECT_FALSE(image.time());
    EXPECT_FALSE(image.neighbour(1));  // there is no such file
}

TEST_F(OfAnImage, RigsAreSeenByOneCamera) {
    const SceneDesc rig = load(
        "cameras:\n  - {name: a, resolution: [4, 3], intrinsics: {fov_x: 60}}\n"
        "  - {name: b, resolution: [8, 6], intrinsics: {fov_x: 60}}\n");
    EXPECT_EQ(rig.camera.width, 4);
    const ImageScene second = scene_of_image(rig, {.frame = 3, .camera = 1});
    EXPECT_EQ(second.desc().camera.width, 8);
    EXPECT_EQ(second.desc().camera_name, "b");
    const ImageScene first = second.seen_by(0);
    EXPECT_EQ(first.desc().camera.width, 4);
    EXPECT_EQ(first.desc().camera_name, "a");
    EXPECT_EQ(first.choice().camera, 0U);
}

TEST_F(OfAnImage, ItHoldsWhatGltfFilesBringOnce) {
    const ImageScene scene = scene_of_image(load(), {3});
    ASSERT_EQ(scene.desc().lamps.size(), 1U);
    EXPECT_EQ(scene.desc().lamps[0].name, "Bulb");
    const ImageScene dark = scene.with([](SceneDesc& desc) { desc.lamps.clear(); });
    const ImageScene copy = dark;
    EXPECT_TRUE(copy.desc().lamps.empty());
    EXPECT_EQ(scene.desc().lamps.size(), 1U);
}

TEST_F(OfAnImage, SequencesWithoutAFrameAreRefused) {
    const auto expect_refused = [](const SceneDesc& scene, const std::string& where) {
        try {
            scene_of_image(scene, {});
            FAIL();
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(where), std::string::npos) << error.what();
        }
    };
    expect_refused(load(), "volumes[0].file: there is no");
    const SceneDesc third = scene_of_image(load(), {3}).desc();
    SceneDesc wind = third;
    wind.volumes[0].motion->is_sequence = true;
    expect_refused(wind, "volumes[0].velocity.file: there is no");
    SceneDesc ship = third;
    ship.geometry[0].is_sequence = true;
    expect_refused(ship, "geometry[0].file: there is no");
}

}  // namespace
}  // namespace uw::test
