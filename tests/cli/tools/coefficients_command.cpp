// ctest labels: unit analytic
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/base/csv_table.h"
#include "core/base/json.h"
#include "core/base/vector_math.h"
#include "tests/support/adaptive_quadrature.h"
#include "tests/support/cli_test.h"

namespace uw::test {
namespace {

constexpr double k_g = 0.8;
constexpr std::array<double, 3> k_a{0.35, 0.08, 0.05}, k_b{0.20, 0.22, 0.25};

/// The camera looks along z, y up; light is scattered once.
constexpr const char* k_sea = R"(uwvdb: 1
camera:
  resolution: [960, 540]
  intrinsics: {fov_x: 60}
  pose: {position: [0, 0, 0], look_at: [0, 0, 1], up: [0, 1, 0]}
water:
  bands: [620, 540, 450]
  absorption: [0.35, 0.08, 0.05]
  scattering: {b: [0.20, 0.22, 0.25], phase: {type: hg, g: 0.8}}
)";

double hg(double cosine) {
    return (1 - k_g * k_g) /
           (4 * std::numbers::pi * std::pow(1 + k_g * k_g - 2 * k_g * cosine, 1.5));
}

class Coefficients : public CliTest {
  protected:
    Json found(const std::string& scene, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"coefficients", scene, "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return Json::parse(result.out);
    }
};

TEST_F(Coefficients, AreTwiceCForALampAtTheCamera) {
    // Beside the camera by 1 cm: the way from lamp to target is longer than d by 5e-5 / d.
    write("lamp.yaml",
          std::string(k_sea) + "lamps:\n  - {position: [0, 0.01, 0], intensity: 50}\n");
    const Json all = found("lamp.yaml", {"--near", "1", "--far", "6", "--count", "5"});
    const std::vector<double> d = all.at("ranges_m");
    ASSERT_EQ(d.size(), 5U);
    for (std::size_t band = 0; band < 3; ++band) {
        SCOPED_TRACE(band);
        const Json& series = all.at("series")[band];
        const double c = k_a[band] + k_b[band];
        EXPECT_NEAR(series.at("c"), c, 1e-5 * c);
        // The images have 7 digits, of which the signal is some 1e-3 at 6 m.
        EXPECT_NEAR(series.at("beta_D"), 2 * c, 1e-3 * c);
        for (std::size_t i = 0; i < d.size(); ++i) {
            EXPECT_NEAR(series.at("white")[i], 50 / std::numbers::pi / (d[i] * d[i]),
                        2e-3 * 50 / std::numbers::pi / (d[i] * d[i]));
            // What the water scatters into the axis, with the lamp's distance from each point.
            const double veil = AdaptiveQuadrature::integrate(
                [&](double s) {
                    const double r = std::hypot(s, 0.01);
                    return 50 / (r * r) * k_b[band] * hg(-s / r) * std::exp(-c * (s + r));
                },
                0.0, d[i], 1e-7);
            EXPECT_NEAR(series.at("backscatter")[i], veil, 3e-3 * veil);
        }
    }
    // With the fall-off left in, 1/d^2 looks like attenuation: 2 / d more, between 1/3 and 2.
    const Json kept =
        found("lamp.yaml", {"--near", "1", "--far", "6", "--count", "5", "--keep-falloff"});
    for (std::size_t band = 0; band < 3; ++band) {
        const double more =
            kept.at("series")[band].at("beta_D").get<double>() - 2 * (k_a[band] + k_b[band]);
        EXPECT_GT(more, 1.0 / 3);
        EXPECT_LT(more, 2);
    }
}

TEST_F(Coefficients, AreCInSunlightSeenHorizontally) {
    write("sun.yaml", std::string(k_sea) + R"(  surface: {height: 5}
lamps:
  - {type: sun, direction: [0.2, -1, 0.6], irradiance: 2}
)");
    const Json all = found("sun.yaml", {"--far", "8", "--count", "6", "--csv", "sun.csv", "--svg",
                                        "sun.svg", "--oceansim", "water.yaml"});
    const Vector3 sun = glm::normalize(Vector3(0.2, -1, 0.6));
    for (std::size_t band = 0; band < 3; ++band) {
        SCOPED_TRACE(band);
        const Json& series = all.at("series")[band];
        const double c = k_a[band] + k_b[band];
        const double irradiance = 2 * std::exp(-c * 5 / -sun.y);  // at the camera's depth
        const double background = irradiance * k_b[band] * hg(-sun.z) / c;
        // Pixels beside the axis look up and down by 1.2 mrad, to water 1 cm away at 8 m.
        EXPECT_NEAR(series.at("beta_D"), c, 1e-3 * c);
        EXPECT_NEAR(series.at("beta_B"), c, 1e-3 * c);
        EXPECT_NEAR(series.at("background"), background, 1e-3 * background);
        for (const double white : series.at("white"))
            EXPECT_NEAR(white, irradiance * sun.z / std::numbers::pi, 1e-3 * white);
        for (const double misfit : series.at("misfit")) EXPECT_LT(std::abs(misfit), 1e-3);
        EXPECT_TRUE(series.at("breaks_at_m").is_null());
    }
    const CsvTable table(read("sun.csv"), "sun.csv");
    EXPECT_EQ(table.row_count(), 18U);
    EXPECT_NEAR(table.where("band", "540 nm").numbers("beta_D")[0], 0.30, 1e-3);
    EXPECT_TRUE(read("sun.svg").starts_with("<"));
    const std::string water = read("water.yaml");
    EXPECT_NE(water.find("atten_coeff: [0.5"), std::string::npos) << water;
    EXPECT_NE(water.find("backscatter_coeff: [0.5"), std::string::npos) << water;
}

TEST_F(Coefficients, SaysWhereTheFormulaBreaks) {
    // A spot 1 m beside the camera lights the axis from 0.8 m on: before that there is no veil, and
    // beyond it the veil grows faster than the formula has it, as a dark target shows.
    write("side.yaml", std::string(k_sea) + R"(lamps:
  - {position: [1, 0, 0], direction: [-0.5, 0, 1], profile: {type: spot, beam: 40, edge: 10}, intensity: 50}
)");
    const std::vector<std::string> arguments{"coefficients", "side.yaml", "--far",        "8",
                                             "--count",      "8",         "--reflectance"};
    const auto with = [&](const char* reflectance) {
        std::vector<std::string> all = arguments;
        all.emplace_back(reflectance);
        return run(all);
    };
    const ProgramResult grey = with("0.5"), dark = with("0.001");
    ASSERT_EQ(grey.exit_code, 0) << grey.err;
    EXPECT_NE(grey.out.find("620 nm beta_D here"), std::string::npos) << grey.out;
    EXPECT_NE(grey.out.find("nowhere"), std::string::npos) << grey.out;
    ASSERT_EQ(dark.exit_code, 0) << dark.err;
    EXPECT_NE(dark.out.find("from 1.1 m"), std::string::npos) << dark.out;
}

TEST_F(Coefficients, HaveColoursOfMoreBands) {
    const Json all = found(
        "scene.yaml", {"--set", "water.bands=[650, 600, 550, 500, 450]", "--set",
                       "water.absorption=[0.35, 0.2, 0.1, 0.08, 0.05]", "--set",
                       "water.scattering.b=0.2", "--set", "lamps.left.intensity=40", "--count", "4",
                       "--set", "geometry[1].reflectance=0.5", "--near", "1", "--far", "3"});
    ASSERT_EQ(all.at("series").size(), 8U);
    EXPECT_EQ(all.at("series")[5].at("name"), "R");
    // Green's curve lies within the bands from 600 to 500 nm, most of it near 550 nm.
    const double green = all.at("series")[6].at("beta_D");
    EXPECT_GT(green, all.at("series")[4].at("beta_D").get<double>());
    EXPECT_LT(green, all.at("series")[1].at("beta_D").get<double>());
}

TEST_F(Coefficients, RefusesWhatCannotBeSeen) {
    write("dark.yaml", std::string(k_sea) + R"(lamps:
  - {position: [0, 0.1, 0], direction: [0, 0, -1], profile: {type: spot, beam: 30}, intensity: 50}
)");
    expect_failure({"coefficients", "dark.yaml", "--quiet"}, 3, "aim a lamp along");
    expect_failure({"coefficients", "scene.yaml", "--near", "2", "--far", "1"}, 2,
                   "--far: 1 m is not beyond");
    expect_failure({"coefficients", "scene.yaml", "--near", "0.01", "--quiet", "--set",
                    "camera.port={type: flat, distance: 0.02, thickness: 0.01}"},
                   3, "the water begins 0.03 m before the camera");
}

}  // namespace
}  // namespace uw::test
