// ctest labels: unit
#include "render/run/job.h"

#include <gtest/gtest.h>

#include <vector>

#include "render/run/draft.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

TEST(JobScenes, AreReadWhenTheyAreDue) {
    std::vector<int> read;
    JobScenes scenes([&](int number) {
        read.push_back(number);
        SceneDesc scene = pinhole_scene(4 + number, 3);
        scene.warnings = {"its own"};
        return scene;
    });
    scenes.warn("of the job");
    EXPECT_EQ(scenes.of(1).camera.width, 5);
    EXPECT_EQ(scenes.look_at({1, {}}).desc().camera.width, 5);
    const ImageScene other = scenes.take({2, {}});
    EXPECT_EQ(other.desc().camera.width, 6);
    EXPECT_EQ(other.desc().warnings, (std::vector<std::string>{"its own", "of the job"}));
    EXPECT_EQ(scenes.take({1, {}}).desc().camera.width, 5);  // kept since it was looked at
    EXPECT_EQ(read, (std::vector<int>{1, 2}));
    EXPECT_EQ(scenes.take({1, {}}).desc().camera.width, 5);
    EXPECT_EQ(read, (std::vector<int>{1, 2, 1}));
}

TEST(ValueGrid, GoesAlongItsFirstAxisFirst) {
    const ValueGrid grid{{{"a", {1, 2, 3}}, {"b", {0.5, 0.25}}}, {{"c", {-1, -2, -3}}}};
    EXPECT_EQ(grid.count(), 6U);
    EXPECT_EQ(grid.keys(), (std::vector<std::string>{"a", "b", "c"}));
    EXPECT_EQ(grid.values_at(0), (std::vector<double>{1, 0.5, -1}));
    EXPECT_EQ(grid.values_at(2), (std::vector<double>{3, 0.5, -3}));
    EXPECT_EQ(grid.values_at(4), (std::vector<double>{2, 0.25, -2}));
    EXPECT_EQ(grid.overrides_at(5), (std::vector<std::string>{"a=3", "b=0.25", "c=-3"}));
}

TEST(Draft, ShowsTheSameViewSmaller) {
    const ImageScene draft = draft_of(pinhole_scene(640, 480), 160);
    const SceneDesc& scene = draft.desc();
    EXPECT_EQ(scene.camera.width, 160);
    EXPECT_EQ(scene.camera.height, 120);
    EXPECT_DOUBLE_EQ(scene.camera.intrinsics.fx,
                     0.25 * pinhole_scene(640, 480).camera.intrinsics.fx);
    EXPECT_EQ(scene.render.quality, RenderDesc::Quality::draft);
    EXPECT_EQ(scene.render.samples, 1);
    EXPECT_EQ(draft_of(pinhole_scene(64, 48), 160).desc().camera.width, 64);  // as it is
    EXPECT_EQ(draft_of(pinhole_scene(64, 480), 32, 100).desc().camera.height, 100);
}

}  // namespace
}  // namespace uw::test
