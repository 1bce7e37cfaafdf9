// ctest labels: unit
#include "cli/command.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace uw {
namespace {

// Hands `text` to the option called `name`, as the command line does.
void give(const Options& options, const std::string& name, const std::string& text = {}) {
    for (const Option& option : options.all())
        if (option.name() == name) return option.take(text);
    ADD_FAILURE() << "no option " << name;
}

std::string refusal(const Options& options, const std::string& name, const std::string& text) {
    try {
        give(options, name, text);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Options, WriteToTheirVariables) {
    bool quiet = false;
    std::string layers;
    std::filesystem::path output;
    std::optional<int> samples;
    int threads = 0;
    double tolerance = 0.001;
    std::vector<std::string> overrides;
    Options options;
    options.flag("--quiet", quiet, "say nothing");
    options.text("--layers", "NAMES", layers, "which");
    options.output("-o,--output", "FILE", output, "where");
    options.integer("--samples", "N", samples, 1, 4096, "how many");
    options.number("--tolerance", "R", tolerance, 0, 1, "how close");
    options.set(overrides);
    options.threads(threads);
    give(options, "--quiet");
    give(options, "--layers", "direct,depth");
    give(options, "--output", "a b.exr");
    give(options, "--samples", "4096");
    give(options, "--tolerance", "1");
    give(options, "--set", "a=1");
    give(options, "--set", "b=2");
    give(options, "--threads", "2");
    EXPECT_TRUE(quiet);
    EXPECT_EQ(layers, "direct,depth");
    EXPECT_EQ(output, "a b.exr");
    EXPECT_EQ(samples, 4096);
    EXPECT_EQ(tolerance, 1);
    EXPECT_EQ(overrides, (std::vector<std::string>{"a=1", "b=2"}));
    EXPECT_EQ(threads, 2);
}

TEST(Options, RefuseWhatIsNoNumberInRange) {
    std::optional<int> samples;
    double tolerance = 0.5;
    Options options;
    options.integer("--samples", "N", samples, 1, 4096, "how many");
    options.number("--tolerance", "R", tolerance, 0, 1, "how close");
    for (const char* text : {"0", "4097", "-1", "1.5", "many", "1x", " 1", "99999999999"})
        EXPECT_EQ(refusal(options, "--samples", text),
                  std::string("--samples: expected 1 to 4096, found '") + text + "'");
    for (const char* text : {"0", "1.0001", "-1", "nan", "inf", "x", "0.5 "})
        EXPECT_EQ(
            refusal(options, "--tolerance", text),
            std::string("--tolerance: expected a number above 0, at most 1; found '") + text + "'");
    EXPECT_FALSE(samples);
    EXPECT_EQ(tolerance, 0.5);
}

TEST(Options, AreFoundByTheirLongNames) {
    std::filesystem::path file;
    Options options;
    EXPECT_EQ(options.output("-o,--output", "FILE", file, "").name(), "--output");
    EXPECT_EQ(options.output("--stats", "FILE", file, "").name(), "--stats");
    const Option& scene = options.input("SCENE", "", file, "");
    EXPECT_EQ(scene.name(), "SCENE");
    EXPECT_TRUE(scene.is_positional());
    EXPECT_FALSE(options.all().front().is_positional());
}

// The command line holds commands in a vector that grows.
TEST(Options, KeepWorkingWhereTheyAreMovedTo) {
    std::optional<int> samples;
    Options options;
    options.integer("--samples", "N", samples, 1, 9, "");
    const Options moved = std::move(options);
    give(moved, "--samples", "7");
    EXPECT_EQ(samples, 7);
    EXPECT_EQ(refusal(moved, "--samples", "x"), "--samples: expected 1 to 9, found 'x'");
}

}  // namespace
}  // namespace uw
