// ctest labels: unit
#include "cli/pages/shell.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

TEST(ManualPage, ListsCommandsOptionsAndExitCodes) {
    std::filesystem::path scene;
    bool quiet = false;
    std::vector<Command> commands;
    commands.push_back({"render", "render a scene", "Examples:\n  uwvdb render a.yaml", {}, {}});
    commands.front().options.input("SCENE", "", scene, "scene file").required = true;
    commands.front().options.flag("--quiet", quiet, "be quiet");
    const std::string page = manual_page(commands);
    EXPECT_TRUE(page.starts_with(".TH UWVDB 1 ")) << page;
    EXPECT_NE(page.find(".B uwvdb render\n[\\fIOPTIONS\\fR] \\fISCENE\\fR\n"), std::string::npos);
    EXPECT_NE(page.find(".SS render\nrender a scene.\n"), std::string::npos);
    EXPECT_NE(page.find("\\fB\\-\\-quiet\\fR\nbe quiet\n"), std::string::npos);
    EXPECT_NE(page.find("uwvdb render a.yaml"), std::string::npos);
    EXPECT_NE(page.find(".B 130\ninterrupted"), std::string::npos);
}

// A line that begins with a dot or a quote would be a request to roff, and a backslash an escape.
TEST(ManualPage, EscapesWhatRoffWouldUnderstand) {
    std::vector<Command> commands;
    commands.push_back({"x", "'quoted' at first", ".dot\n'quote\na\\b", {}, {}});
    const std::string page = manual_page(commands);
    EXPECT_NE(page.find("\n\\&'quoted' at first.\n"), std::string::npos) << page;
    EXPECT_NE(page.find("\n\\&.dot\n\\&'quote\na\\eb\n"), std::string::npos) << page;
}

}  // namespace
}  // namespace uw
