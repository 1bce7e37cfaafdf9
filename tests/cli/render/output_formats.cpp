// ctest labels: unit metamorphic
// Images in the formats that OpenImageIO writes, read back by OpenImageIO itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/image/image_file.h"
#include "tests/support/cli_test.h"

namespace uw {
namespace {

/// The image without its preview, in another format.
class OutputFormats : public test::CliTest {
  protected:
    void expect_runs(const std::string& name, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"render", "scene.yaml", "-o", name};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const test::ProgramResult result = run(arguments);
        ASSERT_EQ(result.exit_code, 0) << result.err;
        EXPECT_NE(result.err.find("wrote " + name), std::string::npos) << result.err;
    }
    /// The largest difference between two files, in R, G and B as OpenImageIO gives them: 0 to 1.
    double difference(const std::string& a, const std::string& b) const {
        const test::ImageFile left = test::read_exr(folder_ / a);
        const test::ImageFile right = test::read_exr(folder_ / b);
        EXPECT_EQ(left.width, right.width);
        EXPECT_EQ(left.height, right.height);
        double largest = 0;
        for (const char* channel : {"R", "G", "B"}) {
            const std::vector<float>& values = left.channels.at(channel);
            for (std::size_t i = 0; i < values.size(); ++i)
                largest = std::max(
                    largest,
                    std::abs(static_cast<double>(values[i] - right.channels.at(channel).at(i))));
        }
        return largest;
    }
    bool has_bits(const std::string& name, const std::string& bits) const {
        return test::read_exr(folder_ / name).formats.at("R") == bits;
    }
};

TEST_F(OutputFormats, OfPicturesHoldTheValuesOfThePng) {
    expect_runs("fine.png", {"--preview-bits", "16"});
    expect_runs("coarse.png");
    for (const std::string name : {"out.tif", "out.TIFF", "out.dpx"}) {
        expect_runs(name);
        EXPECT_LT(difference(name, "fine.png"), 1e-6) << name;
        EXPECT_TRUE(has_bits(name, "uint16")) << name;
    }
    expect_runs("eight.tif", {"--preview-bits", "8"});
    EXPECT_TRUE(has_bits("eight.tif", "uint8"));
    for (const std::string name : {"eight.tif", "out.tga", "out.bmp"}) {
        if (name != "eight.tif") expect_runs(name);
        EXPECT_LT(difference(name, "coarse.png"), 1e-6) << name;
    }
    // Both are lossy, and colour has half the resolution: what counts is that it is that picture.
    for (const std::string name : {"out.jpg", "out.webp"}) {
        expect_runs(name);
        EXPECT_LT(difference(name, "coarse.png"), 0.2) << name;
    }
    // Nothing but what was asked for, and the scene.
    EXPECT_EQ(file_count(), 11U);
}

TEST_F(OutputFormats, OfLightHoldTheLightOfTheExr) {
    expect_runs("out.exr", {"--precision", "float"});
    expect_runs("light.tif", {"--precision", "float"});
    EXPECT_TRUE(has_bits("light.tif", "float"));
    EXPECT_EQ(difference("light.tif", "out.exr"), 0);
    EXPECT_EQ(test::read_exr(folder_ / "light.tif").names.size(), 4U);  // with alpha
    EXPECT_EQ(read("light.png"), read("out.png"));
    expect_runs("light.hdr");
    EXPECT_TRUE(exists("light.png"));
    const test::ImageFile exr = test::read_exr(folder_ / "out.exr");
    const test::ImageFile hdr = test::read_exr(folder_ / "light.hdr");
    for (std::size_t i = 0; i < exr.channels.at("R").size(); ++i) {
        float brightest = 0;
        for (const char* c : {"R", "G", "B"})
            brightest = std::max(brightest, exr.channels.at(c)[i]);
        for (const char* c : {"R", "G", "B"})  // 8 bits of the brightest, rounded down
            ASSERT_NEAR(hdr.channels.at(c)[i], exr.channels.at(c)[i], brightest / 128) << c;
    }
}

TEST_F(OutputFormats, GoThroughRunsOfImages) {
    const test::ProgramResult result =
        run({"render", "scene.yaml", "-o", "f.##.tif", "--frames", "1-2", "--exposure", "first",
             "--contact-sheet", "sheet.png", "--crop", "3,2,20,10"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(read("f.01.tif"), read("f.02.tif"));  // bytes too: there is no date in them
    EXPECT_EQ(test::read_exr(folder_ / "f.01.tif").width, 17);
    EXPECT_EQ(read_image(folder_ / "sheet.png").width, 4 + 1 * (17 + 4));
    EXPECT_FALSE(exists("f.01.png"));
}

TEST_F(OutputFormats, AreRefusedInOneLine) {
    expect_failure({"render", "scene.yaml", "-o", "out.xyz"}, 2,
                   "no format of images has this ending; give a name that ends in .exr, .png");
    expect_failure({"render", "scene.yaml", "-o", "out.bmp", "--preview-bits", "16"}, 2,
                   "a BMP has 8 bits per channel");
    expect_failure({"render", "scene.yaml", "-o", "out.tif", "--precision", "half"}, 2,
                   "use float, or leave it out");
    expect_failure({"render", "scene.yaml", "-o", "out.hdr", "--layers", "depth"}, 2,
                   "is R, G and B alone");
    expect_failure({"render", "scene.yaml", "-o", "out.dpx", "--compression", "zip"}, 2,
                   "is a DPX alone");
    expect_failure({"render", "scene.yaml", "-o", "out.dpx", "--contact-sheet", "sheet.png"}, 2,
                   "DPX is not read; give -o a name that ends in .tif or .png");
    expect_failure({"render", "scene.yaml", "-o", "missing/folder", "--size", "8x4"}, 2, "-o ");
    std::filesystem::copy_file(UWVDB_PROGRAM, folder_ / "alone");  // which has no modules
    const test::ProgramResult result =
        test::run_program({"render", "scene.yaml", "-o", "out.tif"},
                          {.folder = folder_.path(), .program = folder_ / "alone"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find(
                  "-o out.tif: TIFF files need OpenImageIO (the module "
                  "uwvdb_image_formats is not installed); run scripts/demo in the repository"),
              std::string::npos)
        << result.err;
    EXPECT_EQ(test::line_count(result.err), 1);
    EXPECT_EQ(file_count(), 2U);
}

}  // namespace
}  // namespace uw
