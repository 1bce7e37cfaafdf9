// ctest labels: unit
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "core/scene/scene_desc.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

/// The first YAML block of the reference.
std::string documented_scene() {
    std::ifstream stream(UWVDB_SOURCE_DIR "/docs/scene-file.md");
    std::string line;
    std::string scene;
    while (std::getline(stream, line) && line != "```yaml") {
    }
    while (std::getline(stream, line) && line != "```") scene += line + "\n";
    return scene;
}

TEST(SceneDocs, theDocumentedSceneIsRead) {
    const test::SceneFolder folder;
    folder.write("plume.vdb", "x");
    folder.write("seabed.glb", "x");
    const auto file = folder.write("scene.yaml", documented_scene());
    const SceneDesc scene =
        read_scene(file, {"lamps[0].intensity=80", "lamps.left.intensity=[80, 70, 60]",
                          "camera.pose.position=[0, 0, 1]", "camera.intrinsics={fov_x: 75}"});
    EXPECT_EQ(scene.lamps.at(0).intensity, (PerBand{80, 70, 60}));
    EXPECT_EQ(scene.volumes.size(), 1U);
    EXPECT_EQ(scene.geometry.size(), 1U);
    EXPECT_TRUE(scene.warnings.empty());
}

}  // namespace
}  // namespace uw
