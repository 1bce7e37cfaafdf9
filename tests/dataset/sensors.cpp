// ctest labels: unit analytic metamorphic
// What a vehicle's sensors record, as `uwvdb dataset` and `uwvdb record` write it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "core/base/text.h"
#include "core/scene/trajectory.h"
#include "core/scene/yaml_document.h"
#include "tests/support/dataset/dataset_scenes.h"

namespace uw {
namespace {

constexpr std::int64_t k_euroc_zero = 1'400'000'000'000'000'000;

/// A pair that swims for 2 s past the small scene's wall, with an IMU 0.3 m behind it and a DVL.
const std::string k_dive = R"(uwvdb: 1
rig:
  trajectory:
    keyframes:
      - {time: 0, position: [0, 0, 0], look_at: [0, 0, 4], up: [0, -1, 0]}
      - {time: 0.6, position: [0.2, 0.1, 0.1], look_at: [0.1, 0, 4], up: [0.1, -1, 0]}
      - {time: 1.3, position: [0.5, 0.1, 0.2], look_at: [0.3, 0, 4], up: [0, -1, 0]}
      - {time: 2, position: [0.6, -0.1, 0.4], look_at: [0.1, 0.1, 4], up: [-0.1, -1, 0]}
cameras:
  - {name: left, resolution: [8, 6], intrinsics: {fx: 7, fy: 7, cx: 4, cy: 3},
     pose: {position: [0, 0, 0], rotate: [2, 0, 0]}}
  - {name: right, resolution: [8, 6], intrinsics: {fx: 7, fy: 7, cx: 4.2, cy: 3},
     distortion: {k: [-0.1, 0.02, 0]}, pose: {position: [0.1, 0, 0], rotate: [0, -3, 1]}}
sensors:
  - {type: imu, name: front, update_rate: 60, seed: 4, pose: {position: [0.02, 0.1, -0.3],
     rotate: [90, 10, 0]}, accelerometer_noise_density: 0.002, accelerometer_random_walk: 0.003,
     gyroscope_noise_density: 0.0002, gyroscope_random_walk: 0.00002, gyroscope_bias: [0.01, 0, 0]}
  - {type: dvl, name: bottom, update_rate: 8, pose: {rotate: [0, 0, 0]}}
)" + test::small_world() + R"(lamps:
  - {name: left, position: [-0.5, -0.2, 0], intensity: [50, 40, 30]}
render: {fps: 2.5, samples: 1}
)";

using Rows = std::vector<std::vector<double>>;

/// The numbers of a CSV without its header; not a number where a cell is empty.
Rows rows_of(const std::string& text) {
    Rows rows;
    for (const std::string_view line : split(text, '\n')) {
        if (line.empty() || line.front() == '#' || line.starts_with("stamp_ns")) continue;
        std::vector<double>& row = rows.emplace_back();
        for (const std::string_view cell : split(line, ',')) {
            double value = std::nan("");
            if (!cell.empty()) {
                EXPECT_EQ(parse_number(cell, value), NumberText::number) << cell;
            }
            row.push_back(value);
        }
    }
    return rows;
}

/// The stamps of a table, which a double cannot hold.
std::vector<std::int64_t> stamps_of(const std::string& text, char separator = ',') {
    std::vector<std::int64_t> stamps;
    for (const std::string_view line : split(text, '\n')) {
        if (line.empty() || line.front() == '#' || line.starts_with("stamp_ns")) continue;
        stamps.push_back(std::stoll(std::string(line.substr(0, line.find(separator)))));
    }
    return stamps;
}

/// The rigid map of a list of 4 x 4 numbers in a YAML file.
Affine map_of(const ConfigNode& node) {
    std::vector<double> numbers;
    for (const auto& entry : node.items) {
        if (entry.items.empty()) {
            numbers.push_back(std::stod(entry.scalar));
            continue;
        }
        for (const auto& number : entry.items) numbers.push_back(std::stod(number.scalar));
    }
    EXPECT_EQ(numbers.size(), 16U);
    Matrix3 linear(1.0);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            linear[column][row] = numbers[static_cast<std::size_t>(4 * row + column)];
    return {linear, {numbers[3], numbers[7], numbers[11]}};
}

double difference_of(const Affine& a, const Affine& b) {
    double most = glm::length(a.offset() - b.offset());
    for (int i = 0; i < 3; ++i) most = std::max(most, glm::length(a.linear()[i] - b.linear()[i]));
    return most;
}

class SensorFiles : public test::DatasetTest {
  protected:
    SensorFiles() { write("dive.yaml", k_dive); }

    ConfigNode yaml(const std::string& name) const { return parse_yaml(read(name), name); }
    const ConfigNode& at(const ConfigNode& node, const std::string& key) const {
        const ConfigNode* const found = node.find(key);
        if (found == nullptr) throw std::runtime_error("no " + key);
        return *found;
    }
    void record(const std::string& scene, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"record", scene, "-o", "log", "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
    }
};

// The body is the IMU. Where it is, times T_BS, is where the manifest has the cameras: the two come
// about in different ways. Velocities are the derivative of positions.
TEST_F(SensorFiles, EurocHasTheImuAsItsBody) {
    make("dive.yaml", "euroc,sensors", {"--exposure", "1"});
    const auto stamps = stamps_of(read("set/mav0/imu0/data.csv"));
    ASSERT_EQ(stamps.size(), 121U);
    for (std::size_t n = 0; n < stamps.size(); ++n)
        EXPECT_EQ(stamps[n], k_euroc_zero + std::llround(1e9 * static_cast<double>(n) / 60));
    const std::string truth = read("set/mav0/state_groundtruth_estimate0/data.csv");
    EXPECT_EQ(stamps_of(truth), stamps);
    const Rows states = rows_of(truth), readings = rows_of(read("set/mav0/imu0/data.csv"));
    const Rows csv = rows_of(read("set/sensors/front.csv"));
    ASSERT_EQ(csv.size(), 121U);
    const auto imu_at = [&](std::size_t row) {
        const auto& s = states[row];
        return Affine(Rotation{s[4], s[5], s[6], s[7]}.matrix(), {s[1], s[2], s[3]});
    };
    const Json manifest = Json::parse(read("set/manifest.json"));
    for (const Json& view : manifest.at("views")) {
        const auto frame = view.at("frame").get<std::size_t>();
        const bool is_left = view.at("camera") == "left";
        const auto p = view.at("position").get<std::array<double, 3>>();
        const auto q = view.at("rotation_wxyz").get<std::array<double, 4>>();
        const Affine camera(Rotation{q[0], q[1], q[2], q[3]}.matrix(), {p[0], p[1], p[2]});
        const std::string file = fmt::format("set/mav0/cam{}/sensor.yaml", is_left ? 0 : 1);
        const Affine mount = map_of(at(at(yaml(file), "T_BS"), "data"));
        // Frame n is at n/2.5 s, which is row 24 n.
        EXPECT_LT(difference_of(imu_at(24 * frame) * mount, camera), 1e-12) << file;
        EXPECT_EQ(view.at("stamp_ns").get<std::int64_t>() + k_euroc_zero, stamps[24 * frame]);
    }
    for (std::size_t row = 0; row < states.size(); ++row) {
        const auto& s = states[row];
        const auto& c = csv[row];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(readings[row][1 + axis], c[2 + axis]);  // w
            EXPECT_EQ(readings[row][4 + axis], c[5 + axis]);  // a
            EXPECT_EQ(s[11 + axis], c[14 + axis]);            // bias of w
            EXPECT_EQ(s[14 + axis], c[17 + axis]);            // bias of a
            if (row == 0 || row + 1 == states.size()) continue;
            // A jerk below 20 m/s^3, by steps of 1/60 s: their square times a sixth of that.
            const double slope = (states[row + 1][1 + axis] - states[row - 1][1 + axis]) * 30;
            EXPECT_NEAR(s[8 + axis], slope, 1e-3);
        }
    }
    EXPECT_NEAR(states[0][11], 0.01, 1e-15);
    // The body is in its own axes.
    const ConfigNode imu = yaml("set/mav0/imu0/sensor.yaml");
    EXPECT_LT(difference_of(map_of(at(at(imu, "T_BS"), "data")), Affine()), 1e-15);
    EXPECT_EQ(at(imu, "rate_hz").scalar, "60");
    EXPECT_EQ(at(imu, "accelerometer_random_walk").scalar, "0.003");
}

TEST_F(SensorFiles, KalibrsChainAndImuSayTheSame) {
    make("dive.yaml", "euroc,sensors", {"--exposure", "1", "--frames", "2"});
    const ConfigNode chain = yaml("set/mav0/camchain-imucam.yaml");
    std::array<Affine, 2> camera_from_imu;
    for (std::size_t i = 0; i < 2; ++i) {
        camera_from_imu[i] = map_of(at(at(chain, fmt::format("cam{}", i)), "T_cam_imu"));
        const std::string file = fmt::format("set/mav0/cam{}/sensor.yaml", i);
        EXPECT_LT(difference_of(camera_from_imu[i] * map_of(at(at(yaml(file), "T_BS"), "data")),
                                Affine()),
                  1e-14);
    }
    EXPECT_LT(difference_of(map_of(at(at(chain, "cam1"), "T_cn_cnm1")) * camera_from_imu[0],
                            camera_from_imu[1]),
              1e-14);
    // Our own reader of Kalibr's chains takes the second camera from it.
    const test::ProgramResult camera =
        run({"calibration", "set/mav0/camchain-imucam.yaml", "--camera", "cam1", "--to", "scene"});
    EXPECT_EQ(camera.exit_code, 0) << camera.err;
    EXPECT_NE(camera.out.find("cx: 4.2"), std::string::npos) << camera.out;
    // And a scene whose IMU is the file reads the same.
    std::filesystem::copy_file(folder_ / "set/sensors/front.yaml", folder_ / "imu.yaml");
    write("file.yaml", k_dive);
    record("dive.yaml");
    const std::string noisy = read("log/front.csv");
    record("file.yaml", {"--set",
                         "sensors[0]={type: imu, name: front, seed: 4, file: imu.yaml, "
                         "pose: {position: [0.02, 0.1, -0.3], rotate: [90, 10, 0]}, "
                         "gyroscope_bias: [0.01, 0, 0]}"});
    EXPECT_EQ(read("log/front.csv"), noisy);
}

// Frames, shards and threads choose which readings there are, and change none.
TEST_F(SensorFiles, AreTheSameHoweverTheSetIsMade) {
    make("dive.yaml", "euroc,sensors", {"--exposure", "1"});
    std::filesystem::rename(folder_ / "set", folder_ / "whole");
    for (const char* part : {"1/2", "2/2"})
        make("dive.yaml", "euroc,sensors", {"--exposure", "1", "--shard", part, "--threads", "1"});
    ASSERT_EQ(run({"dataset", "--merge", "set", "--quiet"}).exit_code, 0);
    EXPECT_EQ(read("set/SHA256SUMS"), read("whole/SHA256SUMS"));
    for (const char* name : {"mav0/imu0/data.csv", "sensors/front.csv", "sensors/bottom.csv",
                             "sensors/trajectory.tum", "sensors/sensors.json"})
        EXPECT_NE(read("set/SHA256SUMS").find(std::string("  ") + name + "\n"), std::string::npos)
            << name;
    std::filesystem::remove_all(folder_ / "set");
    make("dive.yaml", "euroc,sensors", {"--exposure", "1", "--frames", "2-3"});
    // From 0.8 to 1.2 s, 60 and 8 readings a second, and one beyond where none is on the edge.
    for (const auto& [name, count] :
         {std::pair{"front.csv", std::size_t{25}}, std::pair{"bottom.csv", std::size_t{5}}}) {
        const std::string all = read(std::string("whole/sensors/") + name);
        const std::string some = read(std::string("set/sensors/") + name);
        EXPECT_EQ(stamps_of(some).size(), count) << name;
        const std::string data = some.substr(some.find('\n', some.find("stamp_ns")) + 1);
        EXPECT_NE(all.find("\n" + data), std::string::npos) << name;
    }
}

TEST_F(SensorFiles, TheDataCardListsThemAndWhatIsMissing) {
    make("dive.yaml", "png,euroc", {"--exposure", "1", "--frames", "2"});
    std::string card = read("set/README.md");
    for (const char* text : {"## Sensors", "- `front`: imu, 60 readings a second",
                             "- `bottom`: dvl, 8 readings a second", "IMUs alone"})
        EXPECT_NE(card.find(text), std::string::npos) << text;
    std::filesystem::remove_all(folder_ / "set");
    make("dive.yaml", "png", {"--exposure", "1", "--frames", "2"});
    EXPECT_NE(read("set/README.md").find("not in this set"), std::string::npos);
    std::filesystem::remove_all(folder_ / "set");
    make("moving.yaml", "png", {"--exposure", "1", "--frames", "2"});
    EXPECT_EQ(read("set/README.md").find("Sensors"), std::string::npos);
}

// Without images the readings are those of the data set, and the trajectory comes at any rate.
TEST_F(SensorFiles, RecordWritesTheSameWithoutImages) {
    make("dive.yaml", "euroc,sensors", {"--exposure", "1"});
    record("dive.yaml");
    for (const char* name : {"front.csv", "front.yaml", "bottom.csv", "trajectory.tum",
                             "trajectory.csv", "sensors.json"})
        EXPECT_EQ(read(std::string("log/") + name), read(std::string("set/sensors/") + name))
            << name;
    record("dive.yaml", {"--rate", "1000", "--from", "0.5", "--to", "1.25"});
    const auto stamps = stamps_of(read("log/trajectory.csv"));
    ASSERT_EQ(stamps.size(), 751U);
    for (std::size_t i = 0; i < stamps.size(); ++i)
        EXPECT_EQ(stamps[i], 500'000'000 + 1'000'000 * static_cast<std::int64_t>(i));
    // What it wrote is a trajectory with the same poses.
    std::filesystem::rename(folder_ / "log/trajectory.tum", folder_ / "path.tum");
    record("dive.yaml", {"--set", "rig.trajectory={file: path.tum, start: 0}", "--rate", "100",
                         "--from", "0.6", "--to", "1.2"});
    const Rows again = rows_of(read("log/trajectory.csv"));
    record("dive.yaml", {"--rate", "100", "--from", "0.6", "--to", "1.2"});
    const Rows first = rows_of(read("log/trajectory.csv"));
    ASSERT_EQ(again.size(), 61U);
    for (std::size_t row = 0; row < first.size(); ++row)
        for (std::size_t i = 1; i < 8; ++i) EXPECT_NEAR(again[row][i], first[row][i], 1e-9);
}

// The clock is that of the file of poses, to the nanosecond.
TEST_F(SensorFiles, StampsAreThoseOfTheFileOfPoses) {
    write("poses.csv",
          "1403636579763555584,0,0,0,1,0,0,0\n1403636580263555584,0.1,0,0,1,0,0,0\n"
          "1403636580763555584,0.3,0,0,1,0,0,0\n");
    record("dive.yaml",
           {"--set", "rig.trajectory={file: poses.csv}", "--set", "sensors[0].update_rate=400"});
    const auto stamps = stamps_of(read("log/front.csv"));
    ASSERT_EQ(stamps.size(), 401U);
    for (std::size_t n = 0; n < stamps.size(); ++n)
        EXPECT_EQ(stamps[n], 1403636579763555584 + 2'500'000 * static_cast<std::int64_t>(n));
    EXPECT_NE(read("log/trajectory.tum").find("\n1403636579.763555584 "), std::string::npos);
}

TEST_F(SensorFiles, FaultsAreNamed) {
    expect_failure({"record", "scene.yaml", "-o", "log"}, 2, "--to");
    expect_failure({"record", "dive.yaml", "-o", "log", "--to", "3"}, 2, "from 0 to 2 s");
    expect_failure(
        {"record", "dive.yaml", "-o", "log", "--set", "rig.trajectory.interpolation=linear"}, 3,
        "write interpolation: smooth");
    EXPECT_FALSE(exists("log"));
    expect_failure({"dataset", "dive.yaml", "-o", "set", "--format", "sensors"}, 2, "uwvdb record");
    expect_failure({"dataset", "moving.yaml", "-o", "set", "--format", "png,sensors"}, 2,
                   "has no sensors of a vehicle");
    expect_failure(
        {"record", "scene.yaml", "-o", "log", "--to", "1e6", "--set", "sensors=[{type: imu}]"}, 3,
        "at most 5000000");
    EXPECT_FALSE(exists("set"));
    const test::ProgramResult linear =
        run({"record", "dive.yaml", "-o", "log", "--set", "rig.trajectory.interpolation=linear",
             "--set", "sensors=[]"});
    EXPECT_EQ(linear.exit_code, 0) << linear.err;
    EXPECT_NE(linear.err.find("trajectory.tum alone"), std::string::npos) << linear.err;
    EXPECT_FALSE(exists("log/trajectory.csv"));
}

}  // namespace
}  // namespace uw
