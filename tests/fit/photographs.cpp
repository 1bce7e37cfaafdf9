// ctest labels: analytic
// Ports from corners in real photographs, begun from what anyone would guess: 2 cm before a glass
// of 1 cm that faces ahead, a centred dome, a tank that is 6 cm too thin.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/base/json.h"
#include "tests/support/cli_test.h"

namespace uw::test {
namespace {

constexpr const char* k_rest = R"(
water: {bands: [550], absorption: [0], scattering: {b: [0], phase: {type: hg, g: 0.9}}}
lamps: [{name: l, position: [0, 0, 0.2], intensity: [1]}]
)";

class FitPhotographs : public CliTest {
  protected:
    Json fit(const std::string& camera, const std::string& table, const std::string& unknown) {
        write("rig.yaml", "uwvdb: 1\ncamera: " + camera + k_rest);
        const ProgramResult result =
            run({"fit", "rig.yaml", "--points",
                 std::string(UWVDB_SOURCE_DIR) + "/assets/published/" + table, "--unknown", unknown,
                 "--keep-outliers", "--json", "--quiet"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result.exit_code == 0 ? Json::parse(result.out) : Json();
    }
    static double value(const Json& fit, const std::string& name, const char* key = "value") {
        for (const Json& unknown : fit.at("unknowns"))
            if (unknown.at("name") == name) return unknown.at(key).get<double>();
        ADD_FAILURE() << name;
        return 0;
    }
};

// An independent model of the port leaves 0.357 px; with the port as it is guessed, and the poses
// alone found, 0.399.
TEST_F(FitPhotographs, FlatPort) {
    const Json found = fit(
        "{resolution: [648, 486], intrinsics: {fx: 704.2503362080547, fy: 704.5253520972772, cx: "
        "311.07539864073345, cy: 231.63444961832204}, distortion: {model: brown-conrady, k: "
        "[-0.16466655995965362, 0.3639292712426501, 0], p: [-0.0035347701314374052, "
        "0.0017529132113182353]}, port: {type: flat, normal: [0, 0, 1], distance: 0.02, "
        "thickness: 0.01, n_air: 1.0, n_glass: 1.49, n_water: 1.333}}",
        "flat_port.csv", "camera.port.distance,camera.port.normal");
    EXPECT_LT(found.at("rms").get<double>(), 0.36);
    EXPECT_TRUE(found.at("converged").get<bool>());
    // Its tilt is found to a quarter of a degree.
    EXPECT_NEAR(value(found, "camera.port.normal (tilt 1)"), 1.85, 0.3);
    EXPECT_LT(value(found, "camera.port.normal (tilt 1)", "error"), 0.3);
}

TEST_F(FitPhotographs, Dome) {
    const Json found = fit(
        "{resolution: [1440, 1080], intrinsics: {fx: 2415.732657933524, fy: 2420.953074246, cx: "
        "752.7733815206981, cy: 571.8066981186872}, distortion: {model: brown-conrady, k: "
        "[-0.36315848398496675, 0.06811987606712908, 1.1730456449148083], p: "
        "[0.0009552456724762491, 0.0006011333369216497]}, port: {type: dome, center: [0, 0, 0], "
        "radius: 0.043552, thickness: 0.00375, n_air: 1.0, n_glass: 1.495, n_water: 1.333}}",
        "dome_port.csv", "camera.port.center");
    EXPECT_LT(found.at("rms").get<double>(), 0.2285);
    // The camera was adjusted within the dome by hand, to millimetres.
    EXPECT_NEAR(value(found, "camera.port.center[2]"), -0.0053, 0.0005);
}

// 260 mm were measured; an independent model gives 255.7 +- 1.1 mm and 0.465 px.
TEST_F(FitPhotographs, Tank) {
    const Json found = fit(
        "{resolution: [3456, 2304], intrinsics: {fx: 2855.7123372189926, fy: 2856.713502076052, "
        "cx: 1783.0502357964347, cy: 1171.8751102388067}, port: {type: flat, normal: [0, 0, 1], "
        "distance: 0.02, thickness: 0.2, n_air: 1.0, n_glass: 1.33, n_water: 1.0}}",
        "tank.csv", "camera.port.thickness,camera.port.normal");
    EXPECT_LT(found.at("rms").get<double>(), 0.47);
    const double thickness = value(found, "camera.port.thickness");
    EXPECT_NEAR(thickness, 0.260, 0.005);
    EXPECT_NEAR(value(found, "camera.port.thickness", "error"), 0.0011, 0.0002);
}

}  // namespace
}  // namespace uw::test
