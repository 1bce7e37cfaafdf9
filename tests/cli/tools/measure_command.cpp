// ctest labels: unit
#include <gtest/gtest.h>

#include <string>

#include "core/base/csv_table.h"
#include "core/base/json.h"
#include "tests/support/cli_test.h"

namespace uw::test {
namespace {

constexpr const char* k_cast = R"(uwvdb: 1
camera:
  resolution: [8, 6]
  intrinsics: {fov_x: 60}
  pose: {position: [0, 1, 0], look_at: [0, 1, -1], up: [0, 1, 0]}
water:
  bands: [620, 540]
  absorption: [0.35, 0.08]
  scattering: {b: [0.20, 0.22], phase: {type: hg, g: 0.8}}
  surface: {height: 10, n: 1.34}
sky: {model: overcast, irradiance: [1, 2], samples: 8}
sensors:
  - {name: cast, from: [0, 9, 0], to: [0, 5, 0], count: 2}
  - {position: [0, 8, 0]}
)";

class Measure : public CliTest {
  protected:
    Measure() { write("cast.yaml", k_cast); }
};

TEST_F(Measure, PrintsTablesAndWritesThem) {
    const ProgramResult result =
        run({"measure", "cast.yaml", "--rays", "256", "--csv", "cast.csv", "--svg", "cast.svg"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("cast"), std::string::npos);
    EXPECT_NE(result.out.find("sensor2"), std::string::npos);
    EXPECT_NE(result.out.find("Kd 1/m"), std::string::npos);
    EXPECT_TRUE(read("cast.svg").starts_with("<"));
    const CsvTable table(read("cast.csv"), "cast.csv");
    ASSERT_EQ(table.row_count(), 6U);
    const std::vector<double> depths = table.numbers("depth_m"), down = table.numbers("Ed");
    EXPECT_EQ(depths[0], 1);
    EXPECT_EQ(depths[2], 5);
    EXPECT_GT(down[0], 3 * down[2]);  // 620 nm, 1 m and 5 m down
    EXPECT_LT(down[1], 2);            // what the surface lets through of 2 W/m2
    EXPECT_NE(result.out.find("Rrs 1/sr"), std::string::npos);
    const std::vector<std::string> leaving = table.text("Rrs");
    EXPECT_GT(std::stod(leaving[0]), 0);
    EXPECT_GT(std::stod(leaving[1]), std::stod(leaving[0]));  // 540 nm scatters more, absorbs less
    EXPECT_EQ(leaving[2], "");                                // of a line's first point alone
}

TEST_F(Measure, GivesJson) {
    const ProgramResult result = run({"measure", "cast.yaml", "--rays", "64", "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const Json json = Json::parse(result.out);
    const Json& points = json.at("sensors").at(0).at("points");
    ASSERT_EQ(points.size(), 2U);
    EXPECT_TRUE(points[0].at("Kd")[0].is_null());
    EXPECT_GT(points[1].at("Kd")[0].get<double>(), points[1].at("Kd")[1].get<double>());
    EXPECT_EQ(points[0].at("Ed").size(), 2U);
    const Json& sensor = json.at("sensors").at(0);
    EXPECT_NEAR(sensor.at("Ed_in_air")[1].get<double>(), 2, 1e-9);
    EXPECT_DOUBLE_EQ(sensor.at("Rrs")[1].get<double>(),
                     sensor.at("Lw")[1].get<double>() / sensor.at("Ed_in_air")[1].get<double>());
}

TEST_F(Measure, RefusesWhatItCannotRead) {
    ProgramResult result = run({"measure", "scene.yaml"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.err.find("sensors: there are none; add sensors:"), std::string::npos);
    result = run({"measure", "cast.yaml", "--set", "sensors=[{position: [0, 11, 0]}]"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.err.find("it is 1 m above water.surface"), std::string::npos) << result.err;
    result = run({"measure", "cast.yaml", "--set", "sensors=[{position: [0, 1, 0], count: 3}]"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.err.find("at one position or on a line"), std::string::npos) << result.err;
    result = run(
        {"measure", "cast.yaml", "--set", "sensors=[{position: [0, 1, 0]}]", "--svg", "one.svg"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_FALSE(exists("one.svg"));
}

}  // namespace
}  // namespace uw::test
