// ctest labels: unit analytic statistical
#include "render/navigation/echo_sounding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "core/base/error.h"
#include "render/navigation/sensor_record.h"
#include "render/scene_loading.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

using std::numbers::pi;

/// A camera whose y axis is down in a world whose y is up, going straight from (0, 4, 0) to (8, 6,
/// 4) in 8 s: at rest in its own turn, so that velocities are steady.
constexpr auto k_swim =
    "uwvdb: 1\n"
    "camera:\n  resolution: [4, 4]\n  intrinsics: {fx: 4}\n  trajectory:\n    keyframes:\n"
    "      - {time: 0, position: [0, 4, 0], rotate: [180, 0, 0]}\n"
    "      - {time: 8, position: [8, 6, 4], rotate: [180, 0, 0]}\n";

SceneDesc swimming(const std::string& geometry, const std::string& sensor) {
    return load_scene_text(k_swim + ("geometry:\n" + geometry) + "sensors:\n  - {" + sensor + "}\n",
                           "scene.yaml");
}

/// A table of a record by the names of its columns.
class Table {
  public:
    explicit Table(SensorRecord record) : record_(std::move(record)) {}
    std::size_t rows() const { return record_.numbers.size(); }
    double at(std::size_t row, const std::string& column) const {
        for (std::size_t i = 0; i < record_.columns.size(); ++i)
            if (record_.columns[i] == column)
                return record_.values[row * record_.columns.size() + i];
        ADD_FAILURE() << "no column " << column;
        return 0;
    }

  private:
    SensorRecord record_;
};

Table record_of(const SceneDesc& scene, std::int64_t last) {
    return Table(record_sensor(scene, scene.navigation.front(), {0, last}));
}

constexpr auto k_slope = "  - {type: plane, point: [0, 0, 0], normal: [0.2, 1, -0.1]}\n";
const Vector3 k_normal = glm::normalize(Vector3(0.2, 1, -0.1));

// Each beam's length to a plane with the normal n is -n.(x - x0) / n.d, and its speed v.d. The
// sensor's axes follow from its default pose: x is the camera's, z down, y against the camera's z.
TEST(Dvl, ReadsRangesAndVelocityAboveASlope) {
    const Table table =
        record_of(swimming(k_slope, "type: dvl, update_rate: 4, beam_angle: 25"), 32);
    const Vector3 velocity(1, 0.25, 0.5);
    // World axes of the sensor: the camera's x is x, its y is -y, its z is -z.
    const Matrix3 world_from_sensor(Vector3(1, 0, 0), Vector3(0, 0, 1), Vector3(0, -1, 0));
    const Vector3 in_sensor = glm::transpose(world_from_sensor) * velocity;
    ASSERT_EQ(table.rows(), 33U);
    for (std::size_t row = 0; row < table.rows(); ++row) {
        const double time = 0.25 * static_cast<double>(row);
        const Vector3 position = Vector3(0, 4, 0) + time * velocity;
        EXPECT_EQ(table.at(row, "lock"), 1);
        for (int i = 0; i < 3; ++i) {
            const std::string name = std::string("v") + "xyz"[i];
            EXPECT_NEAR(table.at(row, name + "_true"), in_sensor[i], 1e-12);
            // Without noise least squares give it back.
            EXPECT_NEAR(table.at(row, name), in_sensor[i], 1e-12);
        }
        for (int beam = 0; beam < 4; ++beam) {
            const double azimuth = pi / 4 + beam * pi / 2, angle = 25 * pi / 180;
            const Vector3 own(std::sin(angle) * std::cos(azimuth),
                              std::sin(angle) * std::sin(azimuth), std::cos(angle));
            const Vector3 direction = world_from_sensor * own;
            const double length = -glm::dot(k_normal, position) / glm::dot(k_normal, direction);
            const std::string number = std::to_string(beam + 1);
            EXPECT_NEAR(table.at(row, "range" + number + "_true"), length, 1e-9 * length);
            EXPECT_NEAR(table.at(row, "range" + number), length, 1e-9 * length);
            EXPECT_NEAR(table.at(row, "beam" + number), glm::dot(own, in_sensor), 1e-12);
        }
    }
}

// A cliff's edge: where one beam meets nothing, three lock; where two do, there is no velocity.
TEST(Dvl, LosesBeamsAndThenTheBottom) {
    const auto rows = [](const std::string& box, const std::string& more) {
        return record_of(
            swimming("  - {type: box, " + box + "}\n", "type: dvl, update_rate: 1" + more), 0);
    };
    const auto lost = [](const Table& table) {
        int count = 0;
        for (int beam = 1; beam <= 4; ++beam) {
            const std::string number = std::to_string(beam);
            EXPECT_EQ(std::isnan(table.at(0, "beam" + number)),
                      std::isnan(table.at(0, "range" + number)));
            count += std::isnan(table.at(0, "beam" + number)) ? 1 : 0;
        }
        return count;
    };
    // Beams of 30 degrees from 4 m above meet y = 0 at (+-1.63, +-1.63).
    const Table whole = rows("min: [-5, -1, -5], max: [5, 0, 5]", "");
    EXPECT_EQ(lost(whole), 0);
    const Table corner = rows("min: [-5, -1, -5], max: [1, 0, 5]", "");
    EXPECT_EQ(lost(corner), 2);
    EXPECT_EQ(corner.at(0, "lock"), 0);
    EXPECT_TRUE(std::isnan(corner.at(0, "vx")));
    EXPECT_NEAR(corner.at(0, "vx_true"), 1, 1e-12);
    EXPECT_TRUE(std::isinf(corner.at(0, "range1_true")) || std::isinf(corner.at(0, "range2_true")));
    // 4 / cos 30 is 4.62 m.
    EXPECT_EQ(lost(rows("min: [-5, -1, -5], max: [5, 0, 5]", ", max_range: 4.6")), 4);
    EXPECT_EQ(lost(rows("min: [-5, -1, -5], max: [5, 0, 5]", ", min_range: 4.7")), 4);
    EXPECT_EQ(lost(rows("min: [-5, -1, -5], max: [5, 0, 5]", ", max_incidence: 29.9")), 4);
    EXPECT_EQ(lost(rows("min: [-5, -1, -5], max: [5, 0, 5]", ", max_incidence: 30.1")), 0);
    const Table three = Table(record_sensor(
        swimming("  - {type: box, min: [-5, -1, -5], max: [5, 0, 5]}\n"
                 "  - {type: box, min: [1.4, 0, 1.2], max: [1.9, 2, 1.9]}\n",
                 "type: dvl, update_rate: 1, max_incidence: 45"),
        swimming(k_slope, "type: dvl, update_rate: 1, max_incidence: 45").navigation.front(),
        {0, 0}));
    EXPECT_EQ(lost(three), 1);
    EXPECT_EQ(three.at(0, "lock"), 1);
    EXPECT_NEAR(three.at(0, "vx"), 1, 1e-12);
}

// Independent errors of standard deviation s along four beams at an angle b give s / (2 cos b)
// along the axis, and s / (sqrt(2) sin b) across it.
TEST(Dvl, VelocityHasTheNoiseOfItsBeams) {
    const Table table = record_of(
        swimming(k_slope, "type: dvl, update_rate: 100, velocity_noise: 0.01, range_noise: 0.05"),
        800);
    double across = 0, along = 0, range = 0;
    for (std::size_t row = 0; row < table.rows(); ++row) {
        across += std::pow(table.at(row, "vx") - table.at(row, "vx_true"), 2);
        along += std::pow(table.at(row, "vz") - table.at(row, "vz_true"), 2);
        range += std::pow(table.at(row, "range2") - table.at(row, "range2_true"), 2);
    }
    const auto count = static_cast<double>(table.rows());
    const double tolerance = 4 / std::sqrt(2 * count);  // of a spread's standard error
    EXPECT_NEAR(std::sqrt(across / count) / (0.01 / (std::sqrt(2.0) * 0.5)), 1, tolerance);
    EXPECT_NEAR(std::sqrt(along / count) / (0.01 / (2 * std::cos(pi / 6))), 1, tolerance);
    EXPECT_NEAR(std::sqrt(range / count) / 0.05, 1, tolerance);
    const Table dropped =
        record_of(swimming(k_slope, "type: dvl, update_rate: 100, dropout: 0.2"), 800);
    double lost = 0;
    for (std::size_t row = 0; row < dropped.rows(); ++row)
        lost += std::isnan(dropped.at(row, "beam3")) ? 1 : 0;
    EXPECT_NEAR(lost / count, 0.2, 4 * std::sqrt(0.16 / count));
}

// Straight down to a sphere that swims along below, 3 m under the vehicle, and to the slope.
TEST(Altimeter, SeesWhatMovesAndTheNearestInItsBeam) {
    const Table above = record_of(
        swimming("  - {type: sphere, center: [0, 1, 0], radius: 0.5, trajectory: {keyframes: "
                 "[{time: 0, position: [0, 0, 0]}, {time: 8, position: [8, 2, 4]}]}}\n",
                 "type: altimeter, update_rate: 2"),
        16);
    // Rays and surfaces are traced in single precision.
    for (std::size_t row = 0; row < above.rows(); ++row)
        EXPECT_NEAR(above.at(row, "range_true"), 2.5, 1e-5) << row;
    const Table narrow = record_of(swimming(k_slope, "type: altimeter"), 0);
    EXPECT_NEAR(narrow.at(0, "range"), 4, 1e-9);
    // The slope's foot is 12.6 degrees from straight down: a beam of 40 degrees has it.
    const Table wide = record_of(swimming(k_slope, "type: altimeter, beam: 40"), 0);
    const double foot = 4 * k_normal.y;
    EXPECT_GE(wide.at(0, "range"), foot);
    // A ray is at most 3.6 degrees, of rings 5 degrees apart, from it.
    EXPECT_LE(wide.at(0, "range"), foot / std::cos(3.6 * pi / 180));
    const Table deaf = record_of(swimming(k_slope, "type: altimeter, max_range: 3"), 0);
    EXPECT_TRUE(std::isnan(deaf.at(0, "range")));
}

// The Earth's field turns against the vehicle.
TEST(Magnetometer, ReadsTheFieldInItsAxes) {
    const Table table = record_of(
        swimming(k_slope, "type: magnetometer, field: [2e-5, -4e-5, 1e-5], bias: [1e-6, 0, 0]"),
        10);
    for (std::size_t row = 0; row < table.rows(); ++row) {
        EXPECT_NEAR(table.at(row, "bx_true"), 2e-5, 1e-18);
        EXPECT_NEAR(table.at(row, "by_true"), 4e-5, 1e-18);
        EXPECT_NEAR(table.at(row, "bz_true"), -1e-5, 1e-18);
        EXPECT_NEAR(table.at(row, "bx"), 2.1e-5, 1e-18);
    }
}

TEST(Dvl, IsRefusedWhereVelocitiesJump) {
    SceneDesc scene = load_scene_text(
        std::string(k_swim) + "    interpolation: linear\nsensors: [{type: dvl}]\n", "scene.yaml");
    const std::string message = test::message_of<InputError>([&] {
        record_sensor(scene, scene.navigation.front(), {0, 1});
    });
    EXPECT_NE(message.find("write interpolation: smooth"), std::string::npos) << message;
}

}  // namespace
}  // namespace uw
