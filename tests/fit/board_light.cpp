// ctest labels: metamorphic
// One picture of the printed sheet before dark water, with two lamps on: where the camera was, and
// the water.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/base/json.h"
#include "tests/support/fit_pictures.h"

namespace uw::test {
namespace {

constexpr const char* k_sheet_scene = R"(uwvdb: 1
camera:
  resolution: [480, 360]
  intrinsics: {fov_x: 60}
  port: {type: flat, normal: [0, 0, 1], distance: 0.02, thickness: 0.01, n_glass: 1.49, n_water: 1.334}
SENSOR  pose: {position: [0.15, 0.1, -0.75], look_at: [0.1, 0.06, 0], up: [0, -1, 0]}
water:
  bands: [600, 550, 450]
  absorption: [0.45, 0.2, 0.3]
  scattering: {b: [0.8, 0.85, 0.9], phase: {type: hg, g: 0.9}}
geometry: [{file: sheet.obj}]
lamps:
  - {name: left, position: [-0.4, 0.05, 0], direction: [0.5, 0, 1], profile: {type: spot, beam: 60, edge: 20}, intensity: [3, 3.2, 2.8]}
  - {name: right, position: [0.4, -0.05, 0], direction: [-0.5, 0, 1], profile: {type: spot, beam: 60, edge: 20}, intensity: [2.5, 2.6, 2.4]}
render: {scattering: single}
)";

TEST_F(FitPictures, WaterFromOnePictureOfTheSheet) {
    std::string text = k_sheet_scene;
    text.replace(text.find("SENSOR"), 6, k_raw_sensor);
    text.replace(text.find("23e-6"), 5, "14e-6");
    write("dive.yaml", text);
    ASSERT_EQ(run({"fit", "--target", "sheet.obj", "--quiet"}).exit_code, 0);
    ASSERT_EQ(run({"render", "dive.yaml", "-o", "dive_00.exr", "--quiet"}).exit_code, 0);
    const ProgramResult posed =
        run({"fit", "dive.yaml", "--images", "dive_%02d.sensor.png", "--board", "9x6x0.023",
             "--unknown", "camera.port.distance", "--prior", "camera.port.distance=0.02+-0.001",
             "--found-poses", "poses.json", "--quiet"});
    ASSERT_EQ(posed.exit_code, 0) << posed.err;
    const Json matrix = Json::parse(read("poses.json"))["frames"][0]["transform_matrix"];
    // Corners of a mosaic's numbers are found to 0.13 pixels: 2 mm across at this distance.
    const double place[] = {0.15, 0.1, -0.75};
    for (std::size_t row = 0; row < 3; ++row)
        EXPECT_NEAR(matrix[row][3].get<double>(), place[row], 0.006);
    const Json found =
        fit("dive_%02d.sensor.png", "water.absorption,water.scattering.b",
            {"water.absorption=[0.8, 0.4, 0.6]", "water.scattering.b=[0.4, 0.5, 0.5]"},
            {"--poses", "poses.json"});
    // Three standard errors for what is strongly correlated, and has the pose's error on top.
    expect_found(found,
                 {{"water.absorption[0]", 0.45},
                  {"water.absorption[1]", 0.2},
                  {"water.absorption[2]", 0.3},
                  {"water.scattering.b[0]", 0.8},
                  {"water.scattering.b[1]", 0.85},
                  {"water.scattering.b[2]", 0.9}},
                 3, 0);
    for (const Json& unknown : found.at("unknowns"))
        EXPECT_LT(unknown.at("error").get<double>(), 0.1) << unknown.dump();
}

}  // namespace
}  // namespace uw::test
