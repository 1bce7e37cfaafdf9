// ctest labels: unit
#include <gtest/gtest.h>

#include <variant>

#include "core/scene/navigation_sensor_desc.h"
#include "tests/support/scene_errors.h"

namespace uw {
namespace {

constexpr auto k_begin =
    "uwvdb: 1\n"
    "lamps: [{position: [0, 0, 0], intensity: 1}]\n"
    "camera: {resolution: [64, 48], intrinsics: {fx: 64}}\n"
    "water: {surface: {height: 10}}\n";

/// As the wiki of Kalibr has it.
constexpr auto k_kalibr_imu =
    "#Accelerometers\n"
    "accelerometer_noise_density: 1.86e-03\n"
    "accelerometer_random_walk:   4.33e-04\n"
    "#Gyroscopes\n"
    "gyroscope_noise_density:     1.87e-04\n"
    "gyroscope_random_walk:       2.66e-05\n"
    "rostopic:                    /imu_adis\n"
    "update_rate:                 250.0\n";

class NavigationSensorReader : public test::SceneErrors {
  protected:
    SceneDesc read(const std::string& text) {
        return read_scene(folder_.write("scene.yaml", k_begin + text), {});
    }
};

TEST_F(NavigationSensorReader, EveryKeyOfAnImuIsRead) {
    const SceneDesc scene = read(
        "sensors:\n"
        "  - type: imu\n"
        "    name: front\n"
        "    frame: camera\n"
        "    pose: {position: [0.1, 0.2, 0.3], rotate: [0, 0, 90]}\n"
        "    update_rate: 400\n"
        "    seed: 5\n"
        "    up: [0, 0, 2]\n"
        "    gravity: 9.78\n"
        "    rostopic: /vehicle/imu\n"
        "    accelerometer_noise_density: 0.002\n"
        "    accelerometer_random_walk: 0.003\n"
        "    accelerometer_scale: [1.01, 0.99, 1]\n"
        "    accelerometer_misalignment: [0.001, 0.002, 0.003]\n"
        "    accelerometer_bias: [0.01, 0.02, 0.03]\n"
        "    accelerometer_range: 160\n"
        "    accelerometer_bits: 16\n"
        "    gyroscope_noise_density: 0.0001\n"
        "    gyroscope_random_walk: 0.00002\n"
        "    gyroscope_scale: [1, 1.02, 1]\n"
        "    gyroscope_misalignment: [0, 0, -0.001]\n"
        "    gyroscope_bias: [0.001, 0, 0]\n"
        "    gyroscope_range: 35\n"
        "    gyroscope_bits: 12\n");
    ASSERT_EQ(scene.navigation.size(), 1U);
    const NavigationSensorDesc& sensor = scene.navigation.front();
    EXPECT_STREQ(type_word(sensor), "imu");
    EXPECT_EQ(sensor.name, "front");
    EXPECT_EQ(sensor.update_rate, 400);
    EXPECT_EQ(sensor.seed, 5U);
    EXPECT_EQ(sensor.up, Vector3(0, 0, 1));
    EXPECT_EQ(sensor.body_from_sensor.offset(), Vector3(0.1, 0.2, 0.3));
    EXPECT_NEAR(sensor.body_from_sensor.linear()[0].y, 1, 1e-15);  // x of the sensor is y
    const auto& imu = std::get<ImuDesc>(sensor.kind);
    EXPECT_EQ(imu.gravity, 9.78);
    EXPECT_EQ(imu.rostopic, "/vehicle/imu");
    EXPECT_EQ(imu.accelerometer.noise_density, 0.002);
    EXPECT_EQ(imu.accelerometer.random_walk, 0.003);
    EXPECT_EQ(imu.accelerometer.scale, Vector3(1.01, 0.99, 1));
    EXPECT_EQ(imu.accelerometer.misalignment, Vector3(0.001, 0.002, 0.003));
    EXPECT_EQ(imu.accelerometer.bias, Vector3(0.01, 0.02, 0.03));
    EXPECT_EQ(imu.accelerometer.range, 160);
    EXPECT_EQ(imu.accelerometer.bits, 16);
    EXPECT_EQ(imu.gyroscope.noise_density, 0.0001);
    EXPECT_EQ(imu.gyroscope.random_walk, 0.00002);
    EXPECT_EQ(imu.gyroscope.scale, Vector3(1, 1.02, 1));
    EXPECT_EQ(imu.gyroscope.misalignment, Vector3(0, 0, -0.001));
    EXPECT_EQ(imu.gyroscope.bias, Vector3(0.001, 0, 0));
    EXPECT_EQ(imu.gyroscope.range, 35);
    EXPECT_EQ(imu.gyroscope.bits, 12);
}

TEST_F(NavigationSensorReader, AKalibrFileGivesWhatTheSceneDoesNot) {
    folder_.write("imu.yaml", k_kalibr_imu);
    folder_.write("result.yaml",
                  "imu0:\n  T_i_b:\n  - [1.0, 0.0, 0.0, 0.0]\n  - [0.0, 1.0, 0.0, 0.0]\n"
                  "  - [0.0, 0.0, 1.0, 0.0]\n  - [0.0, 0.0, 0.0, 1.0]\n"
                  "  accelerometer_noise_density: 0.006\n  accelerometer_random_walk: 0.0002\n"
                  "  gyroscope_noise_density: 0.0004\n  gyroscope_random_walk: 4.0e-06\n"
                  "  model: calibrated\n  rostopic: /imu0\n  time_offset: 0.0\n"
                  "  update_rate: 200.0\n");
    const SceneDesc scene = read(
        "sensors:\n"
        "  - {type: imu, file: imu.yaml, gyroscope_random_walk: 1e-6}\n"
        "  - {type: imu, file: result.yaml, update_rate: 100}\n");
    ASSERT_EQ(scene.navigation.size(), 2U);
    EXPECT_EQ(scene.navigation[0].update_rate, 250);
    EXPECT_EQ(scene.navigation[0].up, Vector3(0, 1, 0));
    const auto& first = std::get<ImuDesc>(scene.navigation[0].kind);
    EXPECT_EQ(first.accelerometer.noise_density, 1.86e-3);
    EXPECT_EQ(first.accelerometer.random_walk, 4.33e-4);
    EXPECT_EQ(first.gyroscope.noise_density, 1.87e-4);
    EXPECT_EQ(first.gyroscope.random_walk, 1e-6);
    EXPECT_EQ(first.rostopic, "/imu_adis");
    EXPECT_EQ(scene.navigation[1].update_rate, 100);
    EXPECT_EQ(std::get<ImuDesc>(scene.navigation[1].kind).gyroscope.random_walk, 4e-6);
    ASSERT_EQ(scene.files.size(), 2U);
}

TEST_F(NavigationSensorReader, OtherSensorsHaveTheirKeysAndLightMetersStay) {
    const SceneDesc scene = read(
        "sensors:\n"
        "  - {name: station, position: [0, 5, 0]}\n"
        "  - {type: light, from: [0, 1, 0], to: [0, 9, 0], count: 3}\n"
        "  - {type: pressure, noise: 20, bias: 100, resolution: 5, atmospheric_pressure: 1e5,\n"
        "     gravity: 9.8, tide: {amplitude: 1.5, period: 44714, phase: 0.25}}\n"
        "  - {type: dvl, beam_angle: 20, azimuth: 0, velocity_noise: 0.01, velocity_bias: 0.001,\n"
        "     velocity_resolution: 1e-4, range_noise: 0.02, range_bias: 0.1, range_resolution: "
        "0.01,\n"
        "     dropout: 0.1, min_range: 0.5, max_range: 50, max_incidence: 60}\n"
        "  - {type: altimeter, beam: 10, noise: 0.02, max_range: 30}\n"
        "  - {type: magnetometer, field: [0, -44e-6, -18e-6], noise_density: 1e-8, bias: [1e-6, 0, "
        "0]}\n");
    ASSERT_EQ(scene.meters.size(), 2U);
    EXPECT_EQ(scene.meters[1].name, "sensor2");
    ASSERT_EQ(scene.navigation.size(), 4U);
    const auto& pressure = std::get<PressureDesc>(scene.navigation[0].kind);
    EXPECT_EQ(scene.navigation[0].name, "sensor3");
    EXPECT_EQ(pressure.error.noise, 20);
    EXPECT_EQ(pressure.error.bias, 100);
    EXPECT_EQ(pressure.error.resolution, 5);
    EXPECT_EQ(pressure.atmospheric_pressure, 1e5);
    EXPECT_EQ(pressure.gravity, 9.8);
    EXPECT_EQ(pressure.tide.value().phase, 0.25);
    const auto& dvl = std::get<DvlDesc>(scene.navigation[1].kind);
    EXPECT_EQ(dvl.beam_angle, 20);
    EXPECT_EQ(dvl.azimuth, 0);
    EXPECT_EQ(dvl.velocity.noise, 0.01);
    EXPECT_EQ(dvl.range.bias, 0.1);
    EXPECT_EQ(dvl.dropout, 0.1);
    EXPECT_EQ(dvl.reach.nearest, 0.5);
    EXPECT_EQ(dvl.reach.farthest, 50);
    EXPECT_EQ(dvl.reach.steepest, 60);
    // Without a pose its axis points down in the camera's axes.
    EXPECT_LT(glm::length(scene.navigation[1].body_from_sensor.linear()[2] - Vector3(0, 1, 0)),
              1e-15);
    const auto& altimeter = std::get<AltimeterDesc>(scene.navigation[2].kind);
    EXPECT_EQ(altimeter.beam, 10);
    EXPECT_EQ(altimeter.reach.farthest, 30);
    const auto& magnetometer = std::get<MagnetometerDesc>(scene.navigation[3].kind);
    EXPECT_EQ(magnetometer.field, Vector3(0, -44e-6, -18e-6));
    EXPECT_EQ(magnetometer.error.noise_density, 1e-8);
}

// Poses on a rig that never moves are in the world, those on one that moves in its axes.
TEST_F(NavigationSensorReader, FramesAreThoseOfLamps) {
    const std::string cameras =
        "cameras: [{name: a, resolution: [4, 4], intrinsics: {fx: 4}, pose: {position: [1, 0, 0], "
        "rotate: [0, 0, 0]}}]\n"
        "lamps: [{position: [0, 0, 0], intensity: 1}]\n"
        "sensors: [{type: imu, pose: {position: [0, 2, 0]}}, {type: imu, frame: camera, pose: "
        "{position: [0, 2, 0]}}]\n";
    const SceneDesc still = read_scene(
        folder_.write(
            "still.yaml",
            "uwvdb: 1\nrig: {pose: {position: [0, 0, 3], rotate: [0, 0, 0]}}\n" + cameras),
        {});
    EXPECT_EQ(still.navigation[0].body_from_sensor.offset(), Vector3(0, 2, 3));
    EXPECT_EQ(still.navigation[1].body_from_sensor.offset(), Vector3(1, 2, 3));
    const SceneDesc moving = read_scene(
        folder_.write("moving.yaml",
                      "uwvdb: 1\nrig: {trajectory: {keyframes: [{time: 0, position: [0, 0, 3], "
                      "rotate: [0, 0, 0]}]}}\n" +
                          cameras),
        {});
    EXPECT_EQ(moving.navigation[0].body_from_sensor.offset(), Vector3(0, 2, 0));
    EXPECT_EQ(moving.navigation[1].body_from_sensor.offset(), Vector3(1, 2, 0));
}

TEST_F(NavigationSensorReader, FaultsAreNamedWithTheirMend) {
    folder_.write("imu.yaml", "update_rate: 200\n");
    folder_.write("model.yaml", std::string(k_kalibr_imu) + "model: scale-misalignment\n");
    check(k_begin,
          {{"sensors: [{type: gyro}]", "sensors[0].type"},
           {"sensors: [{type: imu, accelerometer_noise_densty: 1}]", "did you mean"},
           {"sensors: [{type: imu, position: [0, 0, 0]}]", "is not used by type 'imu'"},
           {"sensors: [{position: [0, 0, 0], update_rate: 3}]", "unknown key"},
           {"sensors: [{type: imu, frame: rig}]", "there is no rig in this scene"},
           {"sensors: [{type: imu, update_rate: 0}]", "0.001 to 10000"},
           {"sensors: [{type: imu, gyroscope_bits: 16}]", "spans a range"},
           {"sensors: [{type: imu, gyroscope_scale: [1, 1, 100]}]", "not close to 1"},
           {"sensors: [{type: imu, gyroscope_noise_density: -1}]", "rad/s"},
           {"sensors: [{type: imu, file: none.yaml}]", "no such file"},
           {"sensors: [{type: imu, file: imu.yaml}]", "accelerometer_noise_density"},
           {"sensors: [{type: imu, file: model.yaml}]", "only 'calibrated' is read"},
           {"sensors: [{type: dvl, min_range: 5, max_range: 4}]", "max_range > min_range"},
           {"sensors: [{type: dvl, beam_angle: 90}]", "beam_angle"},
           {"sensors: [{type: magnetometer}]", "field"},
           {"sensors: [{type: magnetometer, field: [0, -44, 0]}]", "stronger than any field"},
           {"sensors: [{type: imu, name: a}, {name: a, position: [0, 0, 0]}]", "is taken"}});
    check(
        "uwvdb: 1\nlamps: [{position: [0, 0, 0], intensity: 1}]\ncamera: {resolution: [4, 4], "
        "intrinsics: {fx: 4}}\n",
        {{"sensors: [{type: pressure}]", "water.surface"}});
}

}  // namespace
}  // namespace uw
