// ctest labels: unit
#include "core/scene/sensor_desc.h"

#include <gtest/gtest.h>

#include "tests/support/scene_errors.h"

namespace uw {
namespace {

constexpr auto k_start =
    "uwvdb: 1\n"
    "lamps: [{position: [0, 0, 0], intensity: 1}]\n"
    "camera:\n"
    "  resolution: [64, 48]\n"
    "  intrinsics: {fx: 2000}\n"
    "  lens: {f_number: 2.8, focal_length: 0.0069}\n";

class SensorReader : public test::SceneErrors {
  protected:
    SceneDesc read(const std::string& text, const std::vector<std::string>& overrides = {}) {
        return read_scene(folder_.write("scene.yaml", k_start + text), overrides);
    }
};

TEST_F(SensorReader, EveryKeyIsRead) {
    const SceneDesc scene = read(
        "  sensor:\n"
        "    exposure: 0.02\n"
        "    pixel_pitch: 3.45e-6\n"
        "    mosaic: grbg\n"
        "    quantum_efficiency: [0.3, 0.6, 0.5]\n"
        "    shot_noise: false\n"
        "    full_well: 10500\n"
        "    dark_current: 1.5\n"
        "    read_noise: 2.4\n"
        "    dsnu: 0.5\n"
        "    prnu: 0.01\n"
        "    gain: 0.38\n"
        "    black_level: 60\n"
        "    bit_depth: 10\n"
        "    seed: 7\n"
        "    image: {demosaic: none, white_balance: [1.9, 1, 1.6], response: {gamma: 2.2}, bits: "
        "8,\n"
        "            format: jpeg, quality: 85}\n");
    EXPECT_TRUE(scene.warnings.empty());
    const SensorDesc& sensor = scene.camera.sensor.value();
    EXPECT_EQ(sensor.exposure, 0.02);
    EXPECT_EQ(sensor.pixel_pitch, 3.45e-6);
    EXPECT_EQ(sensor.mosaic, SensorMosaic::grbg);
    EXPECT_EQ(sensor.quantum_efficiency.values[0], (PerBand{0.3, 0, 0}));
    EXPECT_EQ(sensor.quantum_efficiency.values[1], (PerBand{0, 0.6, 0}));
    EXPECT_EQ(sensor.quantum_efficiency.values[2], (PerBand{0, 0, 0.5}));
    EXPECT_FALSE(sensor.shot_noise);
    EXPECT_EQ(sensor.full_well, 10500);
    EXPECT_EQ(sensor.dark_current, 1.5);
    EXPECT_EQ(sensor.read_noise, 2.4);
    EXPECT_EQ(sensor.dsnu, 0.5);
    EXPECT_EQ(sensor.prnu, 0.01);
    EXPECT_EQ(sensor.system_gain(), 0.38);
    EXPECT_EQ(sensor.black_level, 60);
    EXPECT_EQ(sensor.white_level(), 1023);
    EXPECT_EQ(sensor.seed, 7U);
    EXPECT_FALSE(sensor.image.is_raw);
    EXPECT_FALSE(sensor.image.demosaic);
    EXPECT_EQ(std::get<DevelopmentDesc::Gains>(sensor.image.white_balance),
              (DevelopmentDesc::Gains{1.9, 1, 1.6}));
    EXPECT_EQ(sensor.image.response.type, ResponseCurveDesc::Type::gamma);
    EXPECT_EQ(sensor.image.response.gamma, 2.2);
    EXPECT_EQ(sensor.image.format, DevelopmentDesc::Format::jpeg);
    EXPECT_EQ(sensor.image.quality, 85);
}

TEST_F(SensorReader, MostMayBeLeftOut) {
    const SceneDesc scene = read(
        "  sensor: {quantum_efficiency: 0.5, full_well: 8190}\n"
        "render: {shutter: 0.04}\n");
    const SensorDesc& sensor = scene.camera.sensor.value();
    EXPECT_EQ(sensor.exposure, 0.04);
    EXPECT_EQ(sensor.quantum_efficiency.values[0], (PerBand{0.5, 0.5, 0.5}));
    EXPECT_EQ(sensor.mosaic, SensorMosaic::mono);
    EXPECT_EQ(sensor.bit_depth, 12);
    EXPECT_EQ(sensor.system_gain(), 0.5);
    EXPECT_TRUE(sensor.image.is_raw);
    EXPECT_FALSE(read("").camera.sensor);
}

TEST_F(SensorReader, EfficienciesComeInSeveralForms) {
    const auto efficiency = [&](const std::string& text) {
        return read("  sensor: {exposure: 1, gain: 1, " + text + "}\n")
            .camera.sensor->quantum_efficiency;
    };
    EXPECT_EQ(efficiency("quantum_efficiency: sub/a.csv").file, folder_.path() / "sub/a.csv");
    const auto per_power =
        efficiency("quantum_efficiency: {file: sub/a.csv, per: power, peak: 0.6}, mosaic: rggb");
    EXPECT_TRUE(per_power.is_per_power);
    EXPECT_EQ(per_power.peak, 0.6);
    const auto colours = efficiency(
        "mosaic: three, quantum_efficiency: {r: [0.5, 0.1, 0], g: 0.2, b: [0, 0.1, 0.4]}");
    EXPECT_EQ(colours.values[0], (PerBand{0.5, 0.1, 0}));
    EXPECT_EQ(colours.values[1], (PerBand{0.2, 0.2, 0.2}));
}

TEST_F(SensorReader, PixelsThatDoNotFitTheLensAreTold) {
    const auto warnings =
        read("  sensor: {exposure: 1, gain: 1, quantum_efficiency: 0.5, pixel_pitch: 5e-6}\n")
            .warnings;
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("camera.sensor: pixels of 5 um do not fit a focal length of 6.9 mm, "
                               "2000 pixels, which makes them 3.45 um"),
              std::string::npos)
        << warnings[0];
}

TEST_F(SensorReader, EachCameraOfARigHasItsOwn) {
    const SceneDesc scene =
        read_scene(folder_.write("scene.yaml",
                                 "uwvdb: 1\ncameras:\n"
                                 "  - {name: a, resolution: [9, 9], intrinsics: {fov_x: 60}}\n"
                                 "  - {name: b, resolution: [9, 9], intrinsics: {fov_x: 60},\n"
                                 "     lens: {f_number: 2, focal_length: 0.01},\n"
                                 "     sensor: {quantum_efficiency: 0.5, gain: 1}}\n"
                                 "render: {shutter: 0.1}\n"),
                   {});
    EXPECT_FALSE(scene.cameras[0].camera.sensor);
    EXPECT_EQ(scene.cameras[1].camera.sensor.value().exposure, 0.1);
}

TEST_F(SensorReader, ALensWithAFocusHasMoreSamples) {
    const SceneDesc sharp = read("");
    EXPECT_FALSE(sharp.camera.lens->focus_distance);
    EXPECT_FALSE(sharp.render.samples);
    const SceneDesc focused = read("", {"camera.lens.focus_distance=1.5"});
    EXPECT_EQ(focused.camera.lens->focus_distance, 1.5);
    EXPECT_EQ(focused.render.samples, 64);
    EXPECT_EQ(read("", {"camera.lens.focus_distance=1.5", "render.samples=9"}).render.samples, 9);
    EXPECT_FALSE(
        read("", {"camera.lens.focus_distance=1.5", "render.integrator=path"}).render.samples);
}

TEST_F(SensorReader, WhatCannotBeMeantIsRefused) {
    const std::string start = std::string(k_start) + "  sensor: {";
    check(
        start,
        {
            {"exposure: 1}\n", "scene.yaml:7:11: camera.sensor: 'quantum_efficiency' is missing"},
            {"exposure: 0, quantum_efficiency: 1}\n", "must be greater than 0, found 0"},
            {"exposure: 1, quantum_efficiency: 1}\n",
             "camera.sensor: neither 'gain' [DN/e-] nor 'full_well' [e-] is given"},
            {"gain: 1, quantum_efficiency: 1}\n", "camera.sensor: 'exposure' is missing"},
            {"quantum_eficiency: 1}\n", "did you mean 'quantum_efficiency'?"},
            {"quantum_efficiency: 60}\n",
             "camera.sensor.quantum_efficiency: must be from 0 to 1, found 60"},
            {"quantum_efficiency: {r: 1, g: 1, b: 1}}\n", "a mono sensor has no colours"},
            {"mosaic: rggb, quantum_efficiency: {r: 1, g: 1}}\n", "'b' is missing"},
            {"mosaic: xtrans, quantum_efficiency: 1}\n", "use one of: mono, rggb"},
            {"quantum_efficiency: {file: sub/a.csv, per: power}}\n", "add the greatest efficiency"},
            {"quantum_efficiency: {file: sub/a.csv, r: 1}}\n", "is not used by a quantum"},
            {"quantum_efficiency: 1, pixel_pitch: 3.45}\n", "looks like micrometres"},
            {"quantum_efficiency: 1, gain: 1, bit_depth: 17}\n", "must be from 8 to 16"},
            {"quantum_efficiency: 1, gain: 1, image: {demosaic: bilinear}}\n",
             "this sensor has no Bayer mosaic"},
            {"quantum_efficiency: 1, gain: 1, image: {white_balance: grey-world}}\n",
             "a mono sensor has no colours to balance"},
            {"quantum_efficiency: 1, gain: 1, image: {quality: 9}}\n", "add format: jpeg"},
            {"quantum_efficiency: 1, gain: 1, image: {bits: 12}}\n", "give 8 or 16"},
            {"quantum_efficiency: 1, gain: 1, image: {bits: 16, format: jpeg}}\n",
             "a JPEG has 8 bits"},
            {"exposure: 1, quantum_efficiency: 1, gain: 1}\nrender: {output: sensor_irradiance}\n",
             "camera.sensor: turns radiance into irradiance itself"},
            {"exposure: 1, quantum_efficiency: 1, gain: 1}\nrender: {response: cie}\n",
             "leave out render.response"},
            {"mosaic: rggb, quantum_efficiency: [1, 1], exposure: 1, gain: 1}\n"
             "water: {bands: [500, 600]}\n",
             "only three bands can be red, green and blue themselves"},
        });
    const std::string bare =
        "uwvdb: 1\ncamera:\n  resolution: [9, 9]\n  intrinsics: {fov_x: 60}\n"
        "  sensor: {quantum_efficiency: 1, exposure: 1, gain: 1}\n";
    EXPECT_NE(error_of(bare).find("needs the camera's lens"), std::string::npos);
    const std::string narrow =
        "uwvdb: 1\ncamera:\n  resolution: [9, 1]\n  intrinsics: {fov_x: 60}\n"
        "  lens: {f_number: 2.8, focal_length: 0.0069}\n"
        "  sensor: {quantum_efficiency: 1, exposure: 1, gain: 1, mosaic: rggb}\n";
    EXPECT_NE(error_of(narrow).find("at least two rows and columns"), std::string::npos);
}

}  // namespace
}  // namespace uw
