#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/support/cli_test.h"

namespace uw::test {

/// Those of assets/scenes that take 4 to 15 s each, whatever the size: wavy surfaces, many of them
/// in all light, and a plume that glows.
inline constexpr std::array<std::string_view, 6> k_long_scenes{
    "calm.yaml", "harbour.yaml", "panel.yaml", "shallows.yaml", "sunlit.yaml", "vent.yaml"};

/// The standard error [%] that scenes in all light state of the light in each part of such a small
/// image, which has few nodes, where it is above the 3 % that the program warns of.
inline constexpr std::array<std::pair<std::string_view, double>, 10> k_stated_errors{
    {{"blender.yaml", 6},
     {"calm.yaml", 12},
     {"harbour.yaml", 3},
     {"ies.yaml", 4},
     {"panel.yaml", 4},
     {"plume.yaml", 6},
     {"snow.yaml", 4},
     {"stratified.yaml", 6},
     {"sunlit.yaml", 4},
     {"vent.yaml", 7}}};

/// Renders the scenes of assets/scenes as they are.
class ExampleScenes : public CliTest {
  protected:
    // Renders a scene of the project small; it must be lit, finite and free of doubts.
    void expect_renders(const std::filesystem::path& scene,
                        const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"render", scene.string(), "-o", "out.exr",  "--size",
                                           "96x54",  "--samples",    "1",  "--layers", "all"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run(arguments);
        ASSERT_EQ(result.exit_code, 0) << scene << result.err;
        expect_no_doubts(result.err, scene);
        int images = 0;  // a rig makes one for each camera
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
            if (entry.path().extension() != ".exr") continue;
            expect_lit(read_exr(entry.path()), scene);
            std::filesystem::remove(entry.path());
            ++images;
        }
        EXPECT_GE(images, 1) << scene;
    }

    // Light may be as far off as k_stated_errors says, in whole per cent, and the test's images are
    // wider than some cameras were made for.
    static void expect_no_doubts(const std::string& messages, const std::filesystem::path& scene) {
        const std::string error = "warning: multiple scattering: its standard error is ";
        const auto stated = std::ranges::find(k_stated_errors, scene.filename().string(),
                                              &std::pair<std::string_view, double>::first);
        const double most = stated == k_stated_errors.end() ? 0 : stated->second;
        std::istringstream lines(messages);
        for (std::string line; std::getline(lines, line);) {
            if (line.starts_with(error)) {
                EXPECT_LT(std::stod(line.substr(error.size())), most + 0.5)
                    << scene << ": " << line;
                continue;
            }
            const bool is_aspect = line.find("made for an aspect ratio of") != std::string::npos;
            EXPECT_TRUE(is_aspect || !line.starts_with("warning:")) << scene << ": " << line;
        }
    }

    static void expect_lit(const ImageFile& image, const std::filesystem::path& scene) {
        expect_finite_and_lit(image);
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

}  // namespace uw::test
