// ctest labels: unit
#include "cli/pages/shell.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "tests/support/temp_dir.h"

namespace uw {
namespace {

struct FakeArguments {
    std::filesystem::path scene, output;
    std::string integrator;
    bool quiet = false;
};

Command fake_command(FakeArguments& a) {
    Command command{"render", "render it's [all]: everything", "Examples:", {}, {}};
    command.options.input("SCENE", "", a.scene, "scene file");
    command.options.output("-o,--output", "OUT.exr", a.output, "where to");
    Option& integrator = command.options.text("--integrator", "NAME", a.integrator, "which [one]");
    integrator.value = Option::Value::word;
    integrator.words = {"volume", "planes", "reference"};
    command.options.flag("--quiet", a.quiet, "don't say anything");
    return command;
}

// What bash would offer for the last of `words`, one a line.
std::string offered(const std::string& script, const std::string& words) {
    const test::TempDir folder;
    std::ofstream(folder / "script") << script;
    std::ofstream(folder / "scene.yaml") << "";
    const std::string command = "cd '" + folder.path().string() +
                                "' && bash -c 'set -eu; source ./script; COMP_WORDS=(" + words +
                                "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _uwvdb || true; "
                                "printf \"%s\\n\" \"${COMPREPLY[@]}\"' 2>&1";
    std::string out;
    FILE* const pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return "cannot run bash";
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) out += static_cast<char>(c);
    pclose(pipe);
    return out;
}

TEST(CompletionScript, OfBashOffersCommandsOptionsWordsAndFiles) {
    FakeArguments a;
    std::vector<Command> commands;
    commands.push_back(fake_command(a));
    const std::string script = completion_script("bash", commands);
    EXPECT_EQ(offered(script, "uwvdb re"), "render\n");
    EXPECT_EQ(offered(script, "uwvdb render --i"), "--integrator\n");
    EXPECT_EQ(offered(script, "uwvdb render --integrator \"\""), "volume\nplanes\nreference\n");
    EXPECT_EQ(offered(script, "uwvdb render x --integrator pl"), "planes\n");
    EXPECT_EQ(offered(script, "uwvdb render sce"), "scene.yaml\n");
    EXPECT_EQ(offered(script, "uwvdb render -o sce"), "scene.yaml\n");
}

TEST(CompletionScript, NamesEveryOptionInEveryShell) {
    FakeArguments a;
    std::vector<Command> commands;
    commands.push_back(fake_command(a));
    for (const std::string_view shell : k_shells) {
        const std::string script = completion_script(shell, commands);
        for (const char* word : {"render", "output", "integrator", "volume planes reference",
                                 "quiet", "help", "version"})
            EXPECT_NE(script.find(word), std::string::npos) << shell << ": " << word;
    }
}

TEST(CompletionScript, QuotesWhatHelpTextsHold) {
    FakeArguments a;
    std::vector<Command> commands;
    commands.push_back(fake_command(a));
    const std::string zsh = completion_script("zsh", commands);
    EXPECT_NE(zsh.find(R"('--quiet[don'\''t say anything]')"), std::string::npos) << zsh;
    EXPECT_NE(zsh.find(R"([which \[one\]]:NAME:(volume planes reference))"), std::string::npos);
    EXPECT_NE(zsh.find(R"('(-o --output)'{-o,--output}'[where to]:OUT.exr:_files')"),
              std::string::npos);
    const std::string fish = completion_script("fish", commands);
    EXPECT_NE(fish.find(R"(-l quiet -d 'don\'t say anything')"), std::string::npos) << fish;
    EXPECT_NE(fish.find("-s o -l output -r -F -d 'where to'"), std::string::npos);
}

}  // namespace
}  // namespace uw
