// ctest labels: golden
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>

#include "tests/support/cli_test.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

class ExampleScenes : public test::CliTest {
  protected:
    // Renders a scene of the project small; it must be lit, finite and free of doubts.
    void expect_renders(const std::filesystem::path& scene,
                        const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"render", scene.string(), "-o", "out.exr",  "--size",
                                           "96x54",  "--samples",    "1",  "--layers", "all"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const test::ProgramResult result = run(arguments);
        ASSERT_EQ(result.exit_code, 0) << scene << result.err;
        expect_no_doubts(result.err, scene);
        int images = 0;  // a rig makes one for each camera
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
            if (entry.path().extension() != ".exr") continue;
            expect_lit(test::read_exr(entry.path()), scene);
            std::filesystem::remove(entry.path());
            ++images;
        }
        EXPECT_GE(images, 1) << scene;
    }

    // The standard error [%] of multiple scattering that a scene's first lines state; without one
    // 0.
    static double stated_error(const std::filesystem::path& scene) {
        std::ifstream file(scene);
        const std::string text(std::istreambuf_iterator<char>(file), {});
        std::smatch found;
        return std::regex_search(text, found, std::regex("error of ([0-9]+) %"))
                   ? std::stod(found[1])
                   : 0;
    }

    // Light may be as far off as its scene states, in whole per cent, and the test's images are
    // wider than some cameras were made for.
    static void expect_no_doubts(const std::string& messages, const std::filesystem::path& scene) {
        const std::string error = "warning: multiple scattering: its standard error is ";
        std::istringstream lines(messages);
        for (std::string line; std::getline(lines, line);) {
            if (line.starts_with(error)) {
                EXPECT_LT(std::stod(line.substr(error.size())), stated_error(scene) + 0.5)
                    << scene << ": " << line;
                continue;
            }
            const bool is_aspect = line.find("made for an aspect ratio of") != std::string::npos;
            EXPECT_TRUE(is_aspect || !line.starts_with("warning:")) << scene << ": " << line;
        }
    }

    static void expect_lit(const test::ImageFile& image, const std::filesystem::path& scene) {
        test::expect_finite_and_lit(image);
        float largest = 0;
        for (const auto& [name, values] : image.channels)
            if (name.starts_with("backscatter."))
                for (const float value : values) largest = std::max(largest, value);
        EXPECT_GT(largest, 0) << scene;
        for (const float alpha : image.channels.at("A")) ASSERT_EQ(alpha, 1) << scene;
    }

    const std::filesystem::path scenes_ =
        std::filesystem::path(UWVDB_SOURCE_DIR) / "assets" / "scenes";
};

TEST_F(ExampleScenes, RenderAsTheyAre) {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(scenes_)) {
        if (!entry.is_regular_file() || entry.path().filename() == "houdini.yaml") continue;
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
