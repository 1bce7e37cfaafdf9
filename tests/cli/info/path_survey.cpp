// ctest labels: unit analytic
#include "cli/info/camera_path.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/cli_test.h"
#include "tests/support/xml_check.h"

namespace uw {
namespace {

// Along x at 1 m/s from -1 to 3 m, 1 m above a floor that ends at 1.9 m, through a wall at 0.6 m.
constexpr const char* k_scene = R"(uwvdb: 1
camera:
  resolution: [16, 9]
  intrinsics: {fov_x: 60}
  trajectory:
    interpolation: linear
    keyframes:
      - {time: 0, position: [-1, 1, 0], look_at: [0, 1, 0]}
      - {time: 4, position: [3, 1, 0], look_at: [4, 1, 0]}
geometry:
  - {type: box, min: [-2, -0.2, -1], max: [1.9, 0, 1]}
  - {type: box, min: [0.6, 0.5, -1], max: [0.9, 1.5, 1]}
lamps: [{position: [0, 0.5, 0], intensity: 10}]
render: {fps: 2}
)";

class PathSurveys : public test::CliTest {
  protected:
    PathSurveys() { write("dive.yaml", k_scene); }
    test::ProgramResult info(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{"info"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result;
    }
    nlohmann::json path_of(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{"--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return nlohmann::json::parse(info(arguments).out).at("path");
    }
};

TEST_F(PathSurveys, SayWhereThePathLeavesTheFloorAndEntersASurface) {
    const nlohmann::json path = path_of({"dive.yaml"});
    EXPECT_EQ(path.at("first_frame"), 0);
    EXPECT_EQ(path.at("last_frame"), 8);
    EXPECT_NEAR(path.at("length").get<double>(), 4, 1e-12);
    EXPECT_NEAR(path.at("top_speed").get<double>(), 1, 1e-12);
    EXPECT_EQ(path.at("leaves_floor"), 6);  // at 2 m
    EXPECT_EQ(path.at("enters"), 4);        // at 1 m, from 0.5 m
    EXPECT_EQ(path.at("entered"), "box");
    ASSERT_EQ(path.at("points").size(), 9U);
    EXPECT_NEAR(path.at("points")[1].at("height").get<double>(), 1, 1e-6);
    EXPECT_NEAR(path.at("points")[1].at("position")[0].get<double>(), -0.5, 1e-12);
    EXPECT_TRUE(path.at("points")[7].at("height").is_null());
    const std::string text = info({"dive.yaml"}).out;
    EXPECT_NE(text.find("frames 0-8, 0 to 4 s: 4 m, at most 1 m/s"), std::string::npos) << text;
    EXPECT_NE(text.find("no surface is below it in frame 6 (3 s)"), std::string::npos) << text;
    EXPECT_NE(text.find("it enters a surface: 'box', by frame 4 (2 s)"), std::string::npos) << text;
}

TEST_F(PathSurveys, UpIsWhatIsUpInTheImage) {
    // The world hangs upside down: its floor is at y = 0 above which -y is up.
    std::string turned = k_scene;
    for (const std::string look : {"look_at: [0, 1, 0]", "look_at: [4, 1, 0]"})
        turned.replace(turned.find(look), look.size(), look + ", up: [0, -1, 0]");
    const std::string floor = "min: [-2, -0.2, -1], max: [1.9, 0, 1]";
    turned.replace(turned.find(floor), floor.size(), "min: [-2, 3, -1], max: [1.9, 3.2, 1]");
    write("turned.yaml", turned);
    const nlohmann::json path = path_of({"turned.yaml"});
    EXPECT_EQ(path.at("leaves_floor"), 6);
    EXPECT_NEAR(path.at("points")[0].at("height").get<double>(), 2, 1e-6);
}

TEST_F(PathSurveys, OfStillScenesAreNone) {
    EXPECT_TRUE(path_of({"scene.yaml"}).is_null());
    expect_failure({"info", "scene.yaml", "--svg", "path.svg"}, 2, "nothing in this scene moves");
    EXPECT_FALSE(exists("path.svg"));
}

TEST_F(PathSurveys, AreDrawnOverTheScene) {
    info({"dive.yaml", "--svg", "path.svg"});
    const std::string svg = read("path.svg");
    EXPECT_EQ(test::xml_fault(svg), "");
    for (const char* text : {"dive.yaml", "From above", "Height", "leaves the floor",
                             "enters a surface", "surface below"})
        EXPECT_NE(svg.find(text), std::string::npos) << text;
    expect_failure({"info", "dive.yaml", "--svg", "dive.yaml"}, 4, "a file that this run reads");
}

}  // namespace
}  // namespace uw
