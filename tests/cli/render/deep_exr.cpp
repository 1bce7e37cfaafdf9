// ctest labels: unit
// Deep EXRs, flattened by oiiotool.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

class DeepExr : public test::CliTest {
  protected:
    void oiiotool(const std::vector<std::string>& arguments) const {
        const test::ProgramResult result = test::run_program(
            arguments, {.folder = folder_.path(), .program = "/usr/bin/oiiotool"});
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }
};

// oiiotool adds up alphas in 32-bit floats, in which the light behind an alpha of 1 - 1e-5 is lost
// by 1 %; half a step of the image's half floats is 2^-11 of it.
TEST_F(DeepExr, FlattensToTheImage) {
    const test::ProgramResult result =
        run({"render", "scene.yaml", "-o", "out.exr", "--deep", "24", "--samples", "4"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("out.deep.exr (deep: "), std::string::npos) << result.err;
    oiiotool({"out.deep.exr", "--flatten", "--ch", "R,G,B,A", "-d", "float", "-o", "flat.exr"});
    const test::ImageFile image = test::read_exr(folder_ / "out.exr");
    const test::ImageFile flat = test::read_exr(folder_ / "flat.exr");
    EXPECT_EQ(image.formats.at("R"), "half");
    for (const char* channel : {"R", "G", "B", "A"})
        for (std::size_t i = 0; i < image.channels.at("R").size(); ++i) {
            const auto truth = static_cast<double>(image.channels.at(channel)[i]);
            ASSERT_NEAR(static_cast<double>(flat.channels.at(channel)[i]), truth,
                        (0x1p-11 + 1e-5) * truth)
                << channel << " of pixel " << i;
        }
}

TEST_F(DeepExr, HasTheNameAndTheWindowOfItsImage) {
    ASSERT_EQ(run({"render", "scene.yaml", "-o", "f.##.exr", "--frames", "3", "--deep", "8",
                   "--crop", "4,3,20,11", "--compression", "none"})
                  .exit_code,
              0);
    ASSERT_TRUE(exists("f.03.deep.exr"));
    oiiotool({"f.03.deep.exr", "--flatten", "--ch", "R,G,B,A", "-o", "flat.exr"});
    const test::ImageFile flat = test::read_exr(folder_ / "flat.exr");
    EXPECT_EQ(flat.channels.at("R").size(), 16U * 8U);
}

TEST_F(DeepExr, IsRefusedInOneLine) {
    const auto expect_refused = [&](const std::vector<std::string>& more, const std::string& why) {
        std::vector<std::string> arguments{"render", "scene.yaml", "--deep", "16"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        expect_failure(arguments, 2, why);
    };
    expect_refused({"-o", "a.png"}, "--deep: is for the EXR");
    expect_refused({"-o", "a.exr", "--aces"}, "leave out --aces or --deep");
    expect_refused({"-o", "a.exr", "--integrator", "path"}, "use --integrator volume");
    expect_failure({"render", "scene.yaml", "--deep", "2"}, 2, "--deep");
    EXPECT_FALSE(exists("a.exr"));
    EXPECT_FALSE(exists("a.deep.exr"));
}

}  // namespace
}  // namespace uw
