// ctest labels: unit analytic
// EXRs as ACES image containers (SMPTE ST 2065-4), read by OpenImageIO.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

using AcesContainer = test::CliTest;

TEST_F(AcesContainer, HasTheLightOfTheImageInAces) {
    ASSERT_EQ(run({"render", "scene.yaml", "-o", "srgb.exr", "--precision", "float"}).exit_code, 0);
    const test::ProgramResult result = run({"render", "scene.yaml", "-o", "aces.exr", "--aces"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const test::ImageFile srgb = test::read_exr(folder_ / "srgb.exr");
    const test::ImageFile aces = test::read_exr(folder_ / "aces.exr");
    EXPECT_EQ(aces.names, (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_EQ(aces.formats.at("R"), "half");
    EXPECT_EQ(aces.metadata.at("compression"), "none");
    EXPECT_EQ(aces.metadata.at("acesImageContainerFlag"), "1");
    EXPECT_EQ(aces.metadata.at("uwvdb/rgb_space"), "ACES2065-1");
    EXPECT_EQ(aces.metadata.at("chromaticities"),
              "0.7347, 0.2653, 0, 1, 0.0001, -0.077, 0.32168, 0.33767");
    for (std::size_t i = 0; i < srgb.channels.at("R").size(); ++i) {
        const auto light = [&](const char* c) {
            return static_cast<double>(srgb.channels.at(c)[i]);
        };
        const auto expect_light = [&](const char* c, double r, double g, double b) {
            const double truth = r * light("R") + g * light("G") + b * light("B");
            // Half a step of a half float, and of those near 0.
            ASSERT_NEAR(static_cast<double>(aces.channels.at(c)[i]), truth,
                        0x1p-11 * truth + 0x1p-25)
                << c;
        };
        // The Academy's matrix of BT.709, D65 adapted by Bradford.
        expect_light("R", 0.4396329819, 0.3829886982, 0.1773783199);
        expect_light("G", 0.0897764430, 0.8134394287, 0.0967841283);
        expect_light("B", 0.0175411704, 0.1115465533, 0.8709122763);
    }
    // Its preview is that of the image.
    EXPECT_EQ(read("aces.png"), read("srgb.png"));
}

TEST_F(AcesContainer, IsResumedAndRefused) {
    const std::vector<std::string> frames{"render",   "scene.yaml", "-o",       "f.#.exr",
                                          "--frames", "1-2",        "--resume", "--aces"};
    ASSERT_EQ(run(frames).exit_code, 0);
    EXPECT_NE(run(frames).err.find("frames 1-2 are there already"), std::string::npos);
    std::vector<std::string> usual = frames;
    usual.pop_back();
    EXPECT_EQ(run(usual).err.find("there already"), std::string::npos);
    const auto expect_refused = [&](const std::vector<std::string>& more, const std::string& why) {
        std::vector<std::string> arguments{"render", "scene.yaml", "--aces"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        expect_failure(arguments, 2, why);
    };
    expect_refused({"-o", "a.exr", "--layers", "depth"}, "leave out --aces or --layers");
    expect_refused({"-o", "a.exr", "--precision", "float"}, "leave out --aces or --precision");
    expect_refused({"-o", "a.tif"}, "--aces: is for the EXR");
    expect_refused({"-o", "a.exr", "--set",
                    "render.response=" UWVDB_SOURCE_DIR "/assets/cameras/nikon_d5100.csv"},
                   "which no matrix turns into ACES2065-1");
    EXPECT_FALSE(exists("a.exr"));
}

}  // namespace
}  // namespace uw
