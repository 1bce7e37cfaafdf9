// ctest labels: golden
#include "tests/support/example_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

using test::ExampleScenes;

TEST_F(ExampleScenes, RenderAsTheyAre) {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(scenes_)) {
        if (!entry.is_regular_file() || entry.path().filename() == "houdini.yaml" ||
            std::ranges::count(test::k_long_scenes, entry.path().filename().string()) > 0)
            continue;
        expect_renders(entry.path());
        ++count;
    }
    EXPECT_GE(count, 2);
}

TEST_F(ExampleScenes, TheUsersOwnVolumeIsNamedOnTheCommandLine) {
    // A ball some 100 units high on the ground, as the scene says it expects.
    test::VdbFixture smoke;
    smoke.min = {-25, 0, -25};
    smoke.max = {25, 50, 25};
    smoke.value = [](int i, int j, int k) {
        const double r = std::hypot(i, j - 25, k) / 25;
        return r < 1 ? 1 - r * r : 0;
    };
    smoke.file_from_index = Affine::scale(Vector3(2.0));
    const std::filesystem::path file = folder_ / "smoke of mine.vdb";
    test::write_fixture(file, {smoke}, "Houdini");
    expect_renders(scenes_ / "houdini.yaml", {"--set", "volumes[0].file=" + file.string()});
    const test::ProgramResult missing = run({"render", (scenes_ / "houdini.yaml").string()});
    EXPECT_EQ(missing.exit_code, 3);
    EXPECT_NE(missing.err.find("no such file 'my_houdini.vdb'"), std::string::npos) << missing.err;
}

}  // namespace
}  // namespace uw
