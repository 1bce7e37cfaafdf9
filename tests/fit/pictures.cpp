// ctest labels: metamorphic
// Water and lamps from pictures that were rendered with others.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/base/json.h"
#include "tests/support/fit_pictures.h"

namespace uw::test {
namespace {

// Cells of five pixels stand for their middle: what light does within them to second order is
// left, and b and a make up for each other's errors.
TEST_F(FitPictures, WaterAndBrightnessFromLight) {
    take_pictures("");
    const Json found =
        fit("dive_%02d.exr", "water.absorption,water.scattering.b,lamps.*.intensity",
            {"water.absorption=[0.4, 0.2, 0.1]", "water.scattering.b=[0.15, 0.2, 0.2]",
             "lamps.left.intensity=[40, 40, 40]", "lamps.right.intensity=[40, 40, 40]"});
    EXPECT_TRUE(found.at("converged").get<bool>());
    EXPECT_LT(found.at("relative_rms").get<double>(), 1e-3);
    expect_found(found,
                 {{"water.absorption[0]", 0.25},
                  {"water.absorption[1]", 0.09},
                  {"water.absorption[2]", 0.05},
                  {"water.scattering.b[0]", 0.30},
                  {"water.scattering.b[1]", 0.32},
                  {"water.scattering.b[2]", 0.35},
                  {"lamps.left.intensity[0]", 30},
                  {"lamps.right.intensity[2]", 24}},
                 0, 0.003);
    const std::string page = read("fit.html");
    EXPECT_NE(page.find("Fit of dive.yaml"), std::string::npos);
    EXPECT_NE(page.find("data:image/png"), std::string::npos);  // seen, predicted and difference
}

TEST_F(FitPictures, GainAndBrightnessCannotBeToldApart) {
    take_pictures(k_raw_sensor);
    const Json found = fit("dive_%02d.sensor.png", "camera.sensor.gain,lamps.*.intensity", {});
    const auto& doubts = found.at("doubts");
    ASSERT_FALSE(doubts.empty());
    const std::string first = doubts[0].get<std::string>();
    EXPECT_NE(first.find("camera.sensor.gain"), std::string::npos) << first;
    EXPECT_NE(first.find("lamps.left.intensity[0]"), std::string::npos) << first;
    EXPECT_NE(first.find("cannot be told apart"), std::string::npos) << first;
}

TEST_F(FitPictures, RefusesWhatIsNotThePictureOfTheScene) {
    take_pictures("");
    const auto error = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"fit", "dive.yaml", "--unknown", "water.absorption"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run(arguments);
        EXPECT_NE(result.exit_code, 0);
        return result.err;
    };
    EXPECT_EQ(error({}),
              "uwvdb: give either --points, a table of corners, or --images, photographs\n");
    EXPECT_EQ(error({"--images", "none_%02d.exr"}),
              "uwvdb: none_%02d.exr: there is no such picture for any frame; check the name\n");
    EXPECT_NE(error({"--images", "dive_%02d.exr", "--set", "camera.resolution=[80, 60]"})
                  .find("is 160 x 120 pixels, and the scene's camera 80 x 60; set "
                        "camera.resolution and camera.intrinsics to the picture's"),
              std::string::npos);
    EXPECT_NE(error({"--images", "dive_%02d.exr", "--prior", "water.absorption=1"})
                  .find("give KEY=VALUE+-ERROR"),
              std::string::npos);
}

}  // namespace
}  // namespace uw::test
