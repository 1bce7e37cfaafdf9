// ctest labels: unit metamorphic
#include "cli/tools/calibration_command.h"

#include <gtest/gtest.h>

#include "tests/support/calibration_texts.h"
#include "tests/support/cli_test.h"

namespace uw {
namespace {

class CalibrationCommand : public test::CliTest {
  protected:
    std::string output_of(const std::vector<std::string>& arguments) const {
        const auto result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result.out;
    }
    static void expect_part(const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << part << "\n  in:\n" << text;
    }
};

constexpr const char* k_rest = R"(
water: {preset: jerlov-II}
geometry:
  - {type: plane, point: [0, 0, 3], normal: [0, 0, -1]}
lamps:
  - {position: [-0.5, -0.2, 0], intensity: 50}
)";

TEST_F(CalibrationCommand, ACalibmarFileRendersTheBytesOfTheScenesOwnPort) {
    write("calibration.yaml", test::k_calibmar_flat);
    write("file.yaml", std::string("uwvdb: 1\ncamera: {calibration: calibration.yaml}") + k_rest);
    write("own.yaml", std::string(R"(uwvdb: 1
camera:
  resolution: [1920, 1200]
  intrinsics: {fx: 705.391983, fy: 705.210233, cx: 963.440447, cy: 604.968632}
  distortion: {k: [-0.105541, 0.066014, 0], p: [0.001093, -8.6e-05]}
  port: {normal: [0.01311427226, -0.004460945556, 0.9999040533], distance: 0.02531637365,
         thickness: 0.01, n_air: 1, n_glass: 1.49, n_water: 1.333}
)") + k_rest);
    std::map<std::string, test::ImageFile> images;
    for (const std::string name : {"file", "own"}) {
        output_of({"render", name + ".yaml", "-o", name + ".exr", "--size", "96x60", "--layers",
                   "all", "--quiet"});
        images[name] = test::read_exr(folder_ / (name + ".exr"));
    }
    EXPECT_EQ(images["file"].names, images["own"].names);
    EXPECT_TRUE(images["file"].channels == images["own"].channels);  // every bit of every layer
    EXPECT_NE(images["file"].metadata.at("uwvdb/scene_hash"),
              images["own"].metadata.at("uwvdb/scene_hash"));
}

TEST_F(CalibrationCommand, TheHashOfASceneHoldsItsCalibration) {
    write("scene2.yaml",
          std::string("uwvdb: 1\ncamera: {calibration: {file: rig.txt, camera: 20}}") + k_rest);
    std::vector<std::string> hashes;
    for (const char* digit : {"2", "3"}) {
        write("rig.txt", test::k_colmap + "# " + digit + "\n");
        output_of({"render", "scene2.yaml", "-o", "out.exr", "--size", "16x9", "--quiet"});
        hashes.push_back(test::read_exr(folder_ / "out.exr").metadata.at("uwvdb/scene_hash"));
    }
    EXPECT_NE(hashes[0], hashes[1]);
}

TEST_F(CalibrationCommand, SaysWhatWasUnderstood) {
    write("calibration.yaml", test::k_calibmar_flat);
    const std::string text = output_of({"calibration", "calibration.yaml"});
    expect_part(text, "calibration.yaml: Calibmar calibration\n");
    expect_part(text, "OPENCV, FLATPORT");
    expect_part(text, "1920 x 1200");
    expect_part(text, "in the housing");
    expect_part(text, "in the water");
    expect_part(text, "calibmar, colmap, scene\n");
    expect_part(text, "not opencv, ros: OpenCV and ROS files have no ports");
    write("rig.txt", test::k_colmap);
    expect_part(output_of({"calibration", "rig.txt", "--camera", "12"}), "camera 12 of 5");
    const std::string json = output_of({"calibration", "calibration.yaml", "--json"});
    expect_part(json, R"("format": "calibmar")");
    expect_part(json, R"("type": "flat")");
}

TEST_F(CalibrationCommand, FieldsOfViewByHand) {
    write("c.txt", "1 PINHOLE 2000 1000 1000 1000 1000 500 FLATPORT 0 0 1 0 0 1 1.49 1.334\n");
    // 2 atan 1, 2 atan 1/2 and 2 atan sqrt(5)/2 in air; 2 asin(sin(half) / 1.334) in water.
    const std::string text = output_of({"calibration", "c.txt"});
    expect_part(text, "90.00 x 53.13 deg, diagonal 96.38 in the housing");
    expect_part(text, "64.02 x 39.17 deg, diagonal 67.94 in the water");
    write("f.txt", "1 OPENCV_FISHEYE 1000 1000 200 200 500 500 0 0 0 0\n");
    const std::string fisheye = output_of({"calibration", "f.txt"});
    expect_part(fisheye, "286.48 x 286.48 deg, diagonal 35");  // 1000 / 200 rad; 2 pi at most
    expect_part(fisheye, "up to 180.000 deg off the axis, 628.3 pixels from");
    write("b.txt", "1 SIMPLE_RADIAL 1000 1000 500 500 500 -0.33333333333333333\n");
    // r - r^3 / 3 turns at r = 1, 45 degrees, where it is 2/3.
    expect_part(output_of({"calibration", "b.txt"}),
                "up to 45.000 deg off the axis, 333.3 pixels from the principal point");
}

TEST_F(CalibrationCommand, ConvertsToStandardOutputAndToFiles) {
    write("calibration.yaml", test::k_calibmar_flat);
    const std::string text = output_of({"calibration", "calibration.yaml", "--to", "colmap"});
    expect_part(text, " FLATPORT 0.0131142722");
    EXPECT_TRUE(text.starts_with("#"));
    output_of({"calibration", "calibration.yaml", "--to", "colmap", "-o", "cameras.txt"});
    EXPECT_EQ(read("cameras.txt"), text);
    EXPECT_EQ(read("cameras-plain.txt").find("FLATPORT "), std::string::npos);
    expect_part(read("cameras-plain.txt"), "\n1 OPENCV 1920 1200 ");
    const std::string back = output_of({"calibration", "cameras.txt", "--to", "scene"});
    write("back.yaml", "uwvdb: 1\n" + back + k_rest);
    EXPECT_EQ(output_of({"calibration", "back.yaml", "--to", "colmap"}), text);
    EXPECT_EQ(output_of({"calibration", "back.yaml", "--to", "scene"}), back);
}

TEST_F(CalibrationCommand, TellsTheLateralColourOfAScene) {
    write("port.yaml", std::string(R"(uwvdb: 1
camera:
  resolution: [2000, 1000]
  intrinsics: {fx: 1000}
  port: {n_glass: bk7, n_water: seawater}
)") + k_rest);
    const std::string text = output_of({"calibration", "port.yaml"});
    expect_part(text, "1.51904 (glass), 1.34118 (water)");
    expect_part(text, "of light of 540 nm\n");
    // At the corner, atan(sqrt(5) / 2) = 48.19 deg in air, by Snell's law for each band.
    expect_part(text, "lateral colour   up to 5.06 pixels at 620 nm, 8.83 at 450 nm\n");
    const std::string json = output_of({"calibration", "port.yaml", "--json"});
    expect_part(json, R"("wavelength_nm": 540.0)");
    expect_part(output_of({"calibration", "port.yaml", "--wavelength", "450"}), "1.34586 (water)");
    expect_part(output_of({"calibration", "port.yaml", "--to", "scene"}),
                "n_glass: bk7, n_water: {salinity: 35, temperature: 20}}");
    const auto colmap = run({"calibration", "port.yaml", "--to", "colmap"});
    expect_part(colmap.out, " 1.3411");
    expect_part(colmap.err, "the file holds indices of one wavelength: these are of 540 nm");
    // Numbers have no colour.
    EXPECT_EQ(output_of({"calibration", "scene.yaml"}).find("lateral colour"), std::string::npos);
}

TEST_F(CalibrationCommand, RefusesInOneLine) {
    write("calibration.yaml", test::k_calibmar_flat);
    const std::string file = "calibration.yaml";
    expect_failure({"calibration", file, "--to", "opencv"}, 2, "have no ports; write calibmar");
    expect_failure({"calibration", file, "--to", "colmp"}, 2, "did you mean 'colmap'?");
    expect_failure({"calibration", file, "-o", "x.txt"}, 2, "--to");
    expect_failure({"calibration", file, "--to", "calibmar", "-o", file}, 4,
                   "it is a file that this run reads");
    expect_failure({"calibration", file, "--to", "scene", "--json"}, 2, "give -o");
    expect_failure({"calibration", "scene.yaml", "--camera", "cam0"}, 2, "a scene has one camera");
    expect_failure({"calibration", "none.yaml"}, 4, "no such file");
    write("bad.yaml", "a: b\n");
    expect_failure({"calibration", "bad.yaml"}, 3, "known formats are OpenCV and ROS YAML");
    write("use.yaml", std::string("uwvdb: 1\ncamera: {calibration: bad.yaml}") + k_rest);
    expect_failure({"render", "use.yaml"}, 3, "bad.yaml:1:1: is not in a known calibration format");
    write("two.yaml", std::string("uwvdb: 1\ncamera: {calibration: calibration.yaml, port: "
                                  "{distance: 0.02}}") +
                          k_rest);
    expect_failure({"render", "two.yaml"}, 3,
                   "two.yaml:2:23: camera.calibration: the file has a port of its own");
    write("use.yaml", std::string("uwvdb: 1\ncamera: {calibration: calibration.yaml}") + k_rest);
    expect_failure({"render", "use.yaml", "--stats", "calibration.yaml"}, 2,
                   "would replace a calibration of the scene");
}

TEST_F(CalibrationCommand, APortOfTheSceneGoesWithACalibrationInAir) {
    write("rig.yaml", test::k_ros_plumb_bob);
    write("use.yaml", std::string("uwvdb: 1\ncamera: {calibration: rig.yaml, port: {distance: "
                                  "0.02, thickness: 0.01}}") +
                          k_rest);
    expect_part(output_of({"calibration", "use.yaml"}), "flat: normal [0, 0, 1]");
}

}  // namespace
}  // namespace uw
