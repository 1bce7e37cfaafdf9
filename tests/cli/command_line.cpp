// ctest labels: unit
#include "cli/command.h"

#include <gtest/gtest.h>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

class CommandLine : public test::CliTest {};

TEST_F(CommandLine, VersionAndHelpGoToStdout) {
    const test::ProgramResult version = run({"--version"});
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_TRUE(version.out.starts_with("uwvdb 1.")) << version.out;
    // Scripts read the first line, which has two words; further ones are for people.
    const std::string first = version.out.substr(0, version.out.find('\n'));
    EXPECT_EQ(std::ranges::count(first, ' '), 1) << version.out;
    for (const char* library : {"OpenVDB 1", "Embree ", "OpenEXR 3", "OpenImageIO 2", "GNU "})
        EXPECT_NE(version.out.find(library), std::string::npos) << version.out;
    EXPECT_EQ(version.err, "");

    const test::ProgramResult help = run({"--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.out.find("render a scene to a multi-layer EXR"), std::string::npos);
    EXPECT_NE(help.out.find("Example:\n  uwvdb render "), std::string::npos) << help.out;
    EXPECT_EQ(help.err, "");
}

TEST_F(CommandLine, HelpOfRenderNamesEveryOptionWithExamples) {
    const test::ProgramResult help = run({"render", "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_EQ(help.err, "");
    EXPECT_NE(help.out.find("Usage: uwvdb render [OPTIONS] SCENE"), std::string::npos) << help.out;
    EXPECT_NE(help.out.find("Examples:\n  uwvdb render "), std::string::npos) << help.out;
    for (const char* option :
         {"-o", "--frames", "--resume", "--set", "--size", "--crop", "--integrator", "--layers",
          "--samples", "--threads", "--stats", "--irradiance-vdb", "--quiet"}) {
        EXPECT_NE(help.out.find(option), std::string::npos) << option;
        // The page in docs is the other place to look.
        std::ifstream page(std::string(UWVDB_SOURCE_DIR) + "/docs/command-line.md");
        const std::string text{std::istreambuf_iterator<char>(page), {}};
        EXPECT_NE(text.find(std::string("`") + option), std::string::npos) << option;
    }
}

TEST_F(CommandLine, SaysWhatWasMeant) {
    expect_failure({}, 2, "which command?");
    expect_failure({"rendr", "scene.yaml"}, 2, "'rendr': unknown command; did you mean 'render'?");
    expect_failure({"rendr", "scene.yaml", "--samples", "3"}, 2, "'rendr': unknown command");
    expect_failure({"rendr", "--help"}, 2, "'rendr': unknown command; did you mean 'render'?");
    expect_failure({"--helpp", "--help"}, 2, "--helpp: unknown option; did you mean '--help'?");
    expect_failure({"--versoin"}, 2, "--versoin: unknown option; did you mean '--version'?");
    expect_failure({"render"}, 2, "SCENE is required");
    expect_failure({"render", "scene.yaml", "other.yaml"}, 2, "'other.yaml': not expected");
    expect_failure({"render", "scene.yaml", "--siez", "8x4"}, 2, "did you mean '--size'?");
    expect_failure({"render", "scene.yaml", "--samples"}, 2, "--samples: 1 required N missing");
    expect_failure({"render", "scene.yaml", "-o", ""}, 2, "has an empty value");
}

TEST_F(CommandLine, ValuesThatMakeNoSense) {
    const auto refused = [this](std::vector<std::string> more, const std::string& part) {
        more.insert(more.begin(), {"render", "scene.yaml", "-o", "out.exr"});
        expect_failure(more, 2, part);
    };
    refused({"--size", "640"}, "--size: expected WxH such as 640x360, found '640'");
    refused({"--size", "640x360x2"}, "expected WxH");
    refused({"--size", "0x360"}, "1 to 32768 pixels");
    refused({"--size", "16384x16385"},
            "--size: 16384 x 16385 are more than 268435456 pixels; give a smaller image");
    refused({"--size", "99999999999x1"}, "expected WxH");
    refused({"--quality", "high"}, "--quality: unknown 'high'; use draft, final or exact");
    refused({"--crop", "1,2,3"}, "expected x0,y0,x1,y1, found '1,2,3'");
    refused({"--crop", "0,0,34,19"}, "not a window of the image of 33 x 19 pixels");
    refused({"--crop", "5,5,5,9"}, "not a window");
    refused({"--crop", "-1,0,5,5"}, "not a window");
    refused({"--samples", "0"}, "--samples: expected 1 to 65536, found '0'");
    refused({"--samples", "many"}, "found 'many'");
    refused({"--threads", "-1"}, "--threads: expected 0 to 1024, found '-1'");
    refused({"--integrator", "magic"}, "--integrator: unknown 'magic'; use volume");
    refused({"--layers", "dircet"}, "'dircet': unknown layer; did you mean 'direct'?");
    refused({"--layers", "lamp.lfet"}, "no lamp of that name; did you mean 'left'?");
    refused({"--layers", ""}, "has an empty value");
    refused({"--set", "lamps"}, "not of the form key.path=value");
    refused({"--integrator", "a\nb"}, "unknown 'a?b'");
    EXPECT_FALSE(exists("out.exr"));
}

TEST_F(CommandLine, EveryNameOfAFileKeepsItsEnding) {
    expect_failure({"render", "scene.yaml", "-o", "out.gif"}, 2, "name that ends in .exr, .png");
    expect_failure({"render", "scene.yaml", "-o", ".exr"}, 2, "name that ends in .exr, .png");
    expect_failure({"render", "scene.yaml", "--irradiance-vdb", "out.exr"}, 2, "ends in .vdb");
    EXPECT_EQ(file_count(), 1U);
}

}  // namespace
}  // namespace uw
