// ctest labels: unit
#include "cli/info/fault_report.h"

//
// `uwvdb info --report`: all that is needed to look into a fault, and nothing of the user's files.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

class FaultReport : public test::CliTest {
  protected:
    std::string report(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), {"info", "--report"});
        const test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "");
        return result.out;
    }
    static void expect_parts(const std::string& text, const std::vector<std::string>& parts) {
        std::size_t at = 0;
        for (const std::string& part : parts) {
            const std::size_t found = text.find(part, at);
            EXPECT_NE(found, std::string::npos) << part << " is not where it should be in\n"
                                                << text;
            if (found != std::string::npos) at = found;
        }
    }
};

TEST_F(FaultReport, NeedsNoScene) {
    const std::string text = report({});
    expect_parts(text,
                 {"uwvdb 1.", "\nBuilt with\n    OpenVDB ", "\nMachine\n", ", Linux ", ", glibc ",
                  " processors, ", " GB of memory, ", "\nLoaded\n", "/libopenvdb.so"});
    // Sorted by name, the program is before or after its libraries, by where it was built.
    expect_parts(text, {"\nLoaded\n", "/uwvdb\n"});
    EXPECT_EQ(text.find("\nScene"), std::string::npos);
    expect_failure({"info"}, 2, "which scene or VDB file?");
    expect_failure({"info", "--report", "--json"}, 2, "leave out --json");
}

TEST_F(FaultReport, HasTheSceneButNotItsFiles) {
    write("board.obj", "v 0 0 3\nv 1 0 3\nv 0 1 3\nf 1 2 3\n");
    write("scene.yaml", std::string(test::k_small_scene) +
                            "render: {samples: 3}\n# 4711\ngeometry:\n  - {file: board.obj}\n");
    // The key is there twice: the scene is refused, and is in the report all the same.
    expect_parts(report({"scene.yaml"}), {"\nScene scene.yaml\n    uwvdb: 1\n", "    # 4711\n",
                                          "\nFiles\n    unknown", "\nLog\n    uwvdb: scene.yaml:"});
    std::string scene = test::k_small_scene;
    scene.insert(scene.find("lamps:"), "  - {file: board.obj}\n");
    write("scene.yaml", scene);
    const std::string text = report({"scene.yaml", "--set", "render.samples=3"});
    expect_parts(text, {"\nScene scene.yaml\n    uwvdb: 1\n", "\n--set\n    render.samples=3\n",
                        "\nFiles\n", "board.obj: ", ", 32 bytes\n", "\nLog\n", "lamps"});
    EXPECT_EQ(text.find("f 1 2 3"), std::string::npos);
}

TEST_F(FaultReport, SaysWhatIsMissing) {
    expect_parts(report({"none.yaml"}), {"\nScene none.yaml\n    none.yaml", "\nLog\n    uwvdb: "});
    expect_parts(report({"none.vdb"}), {"\nFile\n    none.vdb: a volume, missing\n",
                                        "\nLog\n    uwvdb: none.vdb: no such file"});
}

TEST_F(FaultReport, DoesNotTellWhoseFolderItIs) {
    const test::ProgramResult result =
        test::run_program({"-c", "HOME=$PWD exec " + std::string(UWVDB_PROGRAM) +
                                     " info --report $PWD/scene.yaml --set render.samples=0"},
                          {.folder = folder_.path(), .program = "/bin/sh"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    expect_parts(result.out, {"\nScene ~/scene.yaml\n", "\nLog\n    uwvdb: "});
    EXPECT_EQ(result.out.find(folder_.path().string()), std::string::npos) << result.out;
}

}  // namespace
}  // namespace uw
