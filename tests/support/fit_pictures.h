#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "tests/support/cli_test.h"

namespace uw::test {

/// A grey plane in front of a camera behind a port, from three places, with two lamps.
inline constexpr const char* k_dive = R"(uwvdb: 1
camera:
  resolution: [160, 120]
  intrinsics: {fov_x: 60}
  port: {type: flat, normal: [0, 0, 1], distance: 0.02, thickness: 0.01, n_glass: 1.49, n_water: 1.334}
SENSOR  trajectory:
    keyframes:
      - {time: 0, position: [0, 0, 1.5], look_at: [0.2, 0, 3], up: [0, -1, 0]}
      - {time: 1, position: [-0.5, 0.1, 0.8], look_at: [0, 0.1, 3], up: [0, -1, 0]}
      - {time: 2, position: [0.3, -0.1, 0], look_at: [0, 0, 3], up: [0, -1, 0]}
water:
  bands: [600, 550, 450]
  absorption: [0.25, 0.09, 0.05]
  scattering: {b: [0.30, 0.32, 0.35], phase: {type: hg, g: 0.9}}
geometry:
  - {type: plane, point: [0, 0, 3], normal: [0, 0, -1], reflectance: 0.5}
lamps:
  - {name: left, position: [-0.6, 0.1, 0.1], direction: [0.15, 0, 1], profile: {type: spot, beam: 60, edge: 20}, intensity: [30, 32, 28]}
  - {name: right, position: [0.55, -0.1, 0.2], direction: [-0.2, 0.05, 1], profile: {type: spot, beam: 60, edge: 20}, intensity: [25, 26, 24]}
render: {fps: 1}
)";

inline constexpr const char* k_raw_sensor =
    "  lens: {f_number: 2.8, focal_length: 0.006}\n"
    "  sensor: {exposure: 0.0002, gain: 0.5, pixel_pitch: 23e-6, mosaic: rggb, quantum_efficiency: "
    "{r: [0.05, 0.005, 0.001], g: [0.005, 0.055, 0.01], b: [0.001, 0.01, 0.05]}, full_well: 8000, "
    "read_noise: 6.8, prnu: 0.01, dsnu: 1, black_level: 64, bit_depth: 12}\n";

class FitPictures : public CliTest {
  protected:
    void take_pictures(const std::string& sensor, const std::vector<std::string>& values = {}) {
        std::string text = k_dive;
        text.replace(text.find("SENSOR"), 6, sensor);
        write("dive.yaml", text);
        std::vector<std::string> arguments{"render",   "dive.yaml", "-o",     "dive_%02d.exr",
                                           "--frames", "0-2",       "--quiet"};
        for (const std::string& value : values) {
            arguments.push_back("--set");
            arguments.push_back(value);
        }
        const ProgramResult result = run(arguments);
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }
    Json fit(const std::string& images, const std::string& unknown,
             const std::vector<std::string>& start, const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments{"fit",       "dive.yaml", "--images", images,
                                           "--unknown", unknown,     "--json",   "--quiet",
                                           "--cells",   "40",        "--report", "fit.html"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        for (const std::string& value : start) {
            arguments.push_back("--set");
            arguments.push_back(value);
        }
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result.exit_code == 0 ? Json::parse(result.out) : Json();
    }
    struct Truth {
        std::string name;
        double value;
    };
    /// Each unknown is within `errors` of its standard errors, or `relative` of the truth.
    static void expect_found(const Json& found, const std::vector<Truth>& truths, double errors,
                             double relative) {
        std::size_t count = 0;
        for (const Json& unknown : found.at("unknowns"))
            for (const Truth& truth : truths)
                if (unknown.at("name") == truth.name) {
                    ++count;
                    const double off = std::abs(unknown.at("value").get<double>() - truth.value);
                    EXPECT_LT(off, errors * unknown.at("error").get<double>() +
                                       relative * std::abs(truth.value))
                        << truth.name << ": " << unknown.dump();
                }
        EXPECT_EQ(count, truths.size());
    }
};

}  // namespace uw::test
