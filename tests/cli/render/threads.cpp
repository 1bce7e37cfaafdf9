// ctest labels: metamorphic threads
// Whole runs on several threads: the same bytes as on one. The thread sanitizer watches them, too.
#include <gtest/gtest.h>

#include <map>

#include "tests/support/cli_test.h"
#include "tests/support/file_bytes.h"

namespace uw {
namespace {

class Threads : public test::CliTest {
  protected:
    /// The files that a run with so many threads writes to a folder of its own, by their names.
    std::map<std::string, std::string> files(const std::string& threads,
                                             std::vector<std::string> arguments) const {
        const std::filesystem::path folder = folder_ / ("threads" + threads);
        std::filesystem::create_directory(folder);
        arguments.insert(arguments.end(), {"--threads", threads, "--quiet"});
        const test::ProgramResult result = test::run_program(arguments, {.folder = folder});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        std::map<std::string, std::string> content;
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            content[entry.path().filename().string()] = test::file_bytes(entry.path());
        return content;
    }

    void expect_same_files(const std::vector<std::string>& arguments,
                           const std::vector<std::string>& names) const {
        const auto one = files("1", arguments), four = files("4", arguments);
        EXPECT_EQ(one.size(), names.size());
        EXPECT_EQ(four.size(), names.size());
        for (const std::string& name : names) {
            ASSERT_TRUE(one.contains(name) && four.contains(name)) << name;
            EXPECT_TRUE(one.at(name) == four.at(name)) << name;
        }
    }

    static std::string scene(const std::string& name) {
        return (std::filesystem::path(UWVDB_SOURCE_DIR) / "assets/scenes" / name).string();
    }
};

TEST_F(Threads, MakeTheSamePlumeWithForwardScatter) {
    expect_same_files(
        {"render", scene("plume.yaml"), "-o", "out.exr", "--size", "32x18", "--samples", "1",
         "--quality", "draft", "--layers", "all", "--set",
         "water.forward_scatter={K: 0.5, B: 0.01}", "--set", "render.scattering=single"},
        {"out.exr", "out.png", "out_ids.csv"});
}

TEST_F(Threads, MakeTheSameMultipleScatteringOfSunAndLamps) {
    expect_same_files({"render", scene("sunlit.yaml"), "-o", "out.exr", "--size", "16x9",
                       "--samples", "1", "--quality", "draft"},
                      {"out.exr", "out.png"});
}

TEST_F(Threads, MakeTheSamePaths) {
    expect_same_files(
        {"render", scene("plume.yaml"), "-o", "out.exr", "--size", "16x9", "--samples", "2",
         "--integrator", "path", "--set", "render.scattering=multiple"},
        {"out.exr", "out.png"});
}

TEST_F(Threads, MakeTheSameSnow) {
    expect_same_files(
        {"render", scene("snow.yaml"), "-o", "out.exr", "--size", "32x18", "--samples", "2"},
        {"out.exr", "out.png"});
}

TEST_F(Threads, MakeTheSameSensorImage) {
    expect_same_files(
        {"render", scene("camera.yaml"), "-o", "out.exr", "--size", "32x20", "--samples", "1"},
        {"out.exr", "out.png", "out.sensor.png"});
}

// While a frame is written by a thread of its own, the next is rendered.
TEST_F(Threads, MakeTheSameSequence) {
    expect_same_files(
        {"render", scene("dive.yaml"), "-o", "#.exr", "--size", "32x18", "--quality", "draft",
         "--frames", "0-3", "--exposure", "first", "--contact-sheet", "sheet.png"},
        {"0.exr", "0.png", "1.exr", "1.png", "2.exr", "2.png", "3.exr", "3.png", "sheet.png"});
}

}  // namespace
}  // namespace uw
