// ctest labels: unit
#include "tests/support/cli_test.h"

namespace uw {
namespace {

using RgbSpace = test::CliTest;

TEST_F(RgbSpace, IsThatOfTheResponse) {
    const std::string camera = UWVDB_SOURCE_DIR "/assets/cameras/nikon_d5100.csv";
    const auto space_with = [&](const std::vector<std::string>& settings) {
        std::vector<std::string> arguments{"--layers", "default", "--size", "8x4"};
        for (const std::string& setting : settings) {
            arguments.emplace_back("--set");
            arguments.push_back(setting);
        }
        return render(arguments).metadata.at("uwvdb/rgb_space");
    };
    EXPECT_EQ(space_with({}), "bands");
    EXPECT_EQ(space_with({"render.response=bands"}), "bands");
    EXPECT_EQ(space_with({"render.response=cie"}), "linear sRGB");
    EXPECT_EQ(space_with({"render.response=cie", "render.white=none"}), "linear sRGB");
    EXPECT_EQ(space_with({"render.response=" + camera}), "of the camera");
    EXPECT_EQ(
        space_with({"water.bands=[540]", "water.absorption=[0.08]", "water.scattering.b=[0.2]",
                    "geometry[1].reflectance=[0.7]", "lamps.left.intensity=[50]"}),
        "linear sRGB");
}

}  // namespace
}  // namespace uw
