// ctest labels: metamorphic slow
// Water and lamps from raw pictures of a plane.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "tests/support/fit_pictures.h"

namespace uw::test {
namespace {

// As cameras store them: a mosaic's raw numbers with shot noise and pixels that differ by 1 %. Four
// standard errors for six numbers: less than one run in a thousand fails for no reason.
TEST_F(FitPictures, WaterFromRawNumbers) {
    take_pictures(k_raw_sensor);
    const Json found =
        fit("dive_%02d.sensor.png", "water.absorption,water.scattering.b",
            {"water.absorption=[0.4, 0.2, 0.1]", "water.scattering.b=[0.15, 0.2, 0.2]"});
    // What the cells' means may be off by is known from the sensor.
    EXPECT_NEAR(found.at("rms").get<double>(), 1, 0.1);
    expect_found(found,
                 {{"water.absorption[0]", 0.25},
                  {"water.absorption[1]", 0.09},
                  {"water.absorption[2]", 0.05},
                  {"water.scattering.b[0]", 0.30},
                  {"water.scattering.b[1]", 0.32},
                  {"water.scattering.b[2]", 0.35}},
                 4, 0);
}

// As cameras store them: a mosaic's raw numbers with shot noise and pixels that differ by 1 %. Four
// standard errors for ten numbers: less than one run in a thousand fails for no reason.
TEST_F(FitPictures, LampsFromRawNumbers) {
    take_pictures(k_raw_sensor);
    const Json found = fit("dive_%02d.sensor.png", "lamps.*.position,lamps.*.direction",
                           {"lamps.left.position=[-0.5, 0, 0]", "lamps.left.direction=[0, 0, 1]",
                            "lamps.right.position=[0.5, 0, 0]", "lamps.right.direction=[0, 0, 1]"});
    EXPECT_TRUE(found.at("converged").get<bool>());
    // The scatter of the cells says what their means may be off by.
    EXPECT_NEAR(found.at("rms").get<double>(), 1, 0.1);
    // A centimetre and a degree are what was asked of it.
    expect_found(found,
                 {{"lamps.left.position[0]", -0.6},
                  {"lamps.left.position[1]", 0.1},
                  {"lamps.left.position[2]", 0.1},
                  {"lamps.right.position[0]", 0.55},
                  {"lamps.right.position[1]", -0.1},
                  {"lamps.right.position[2]", 0.2},
                  {"lamps.left.direction (tilt 1)", std::atan(0.15) * 180 / 3.14159265358979},
                  {"lamps.left.direction (tilt 2)", 0}},
                 4, 0);
    for (const Json& unknown : found.at("unknowns"))
        EXPECT_LT(unknown.at("error").get<double>(), unknown.at("unit") == "deg" ? 1.0 : 0.01)
            << unknown.dump();
}

// A lamp's place, its direction and, as a table, how bright it is by the angle from that, all at
// once. Four standard errors as above.
TEST_F(FitPictures, ProfileFromRawNumbers) {
    const std::string profile = "lamps.left.profile={type: table, angles: [0, 10, 20, 30, 40], ";
    take_pictures(k_raw_sensor, {profile + "values: [0.9, 1, 0.7, 0.3, 0.1]}"});
    const Json found = fit("dive_%02d.sensor.png",
                           "lamps.left.position,lamps.left.direction,"
                           "lamps.left.profile.values",
                           {profile + "values: [0.8, 0.8, 0.5, 0.2, 0.2]}",
                            "lamps.left.position=[-0.5, 0, 0]", "lamps.left.direction=[0, 0, 1]"},
                           {"-o", "found.yaml"});
    EXPECT_TRUE(found.at("converged").get<bool>());
    EXPECT_NEAR(found.at("rms").get<double>(), 1, 0.1);
    // What --set said is in the fitted scene, too.
    EXPECT_EQ(run({"info", "found.yaml"}).exit_code, 0);
    EXPECT_NE(read("found.yaml").find("angles: [0, 10, 20, 30, 40]"), std::string::npos);
    expect_found(found,
                 {{"lamps.left.position[0]", -0.6},
                  {"lamps.left.position[1]", 0.1},
                  {"lamps.left.position[2]", 0.1},
                  {"lamps.left.direction (tilt 1)", std::atan(0.15) * 180 / 3.14159265358979},
                  {"lamps.left.direction (tilt 2)", 0},
                  {"lamps.left.profile.values[0]", 0.9},
                  {"lamps.left.profile.values[1]", 1},
                  {"lamps.left.profile.values[2]", 0.7},
                  {"lamps.left.profile.values[3]", 0.3},
                  {"lamps.left.profile.values[4]", 0.1}},
                 4, 0);
    // The outermost, of which the plane shows little, to 5 %.
    for (const Json& unknown : found.at("unknowns")) {
        const bool is_last = unknown.at("name") == "lamps.left.profile.values[4]";
        const double most = unknown.at("unit") == "deg" ? 1.0 : is_last ? 0.05 : 0.02;
        EXPECT_LT(unknown.at("error").get<double>(), most) << unknown.dump();
    }
}

}  // namespace
}  // namespace uw::test
