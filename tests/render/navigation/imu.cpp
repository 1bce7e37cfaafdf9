// ctest labels: unit analytic statistical
#include "render/navigation/imu.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "render/scene_loading.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

using std::numbers::pi;

/// A scene with a camera that moves or rests as `motion` says, and sensors.
SceneDesc scene_with(const std::string& motion, const std::string& sensors) {
    return load_scene_text("uwvdb: 1\ncamera:\n  resolution: [4, 4]\n  intrinsics: {fx: 4}\n" +
                               motion + "\nsensors:\n" + sensors,
                           "scene.yaml");
}

std::string keyframe(double time, const Pose& pose) {
    const Matrix3 m = pose.rotation.matrix();
    const Point3& p = pose.position;
    return fmt::format(
        "      - {{time: {}, matrix: [[{}, {}, {}, {}], [{}, {}, {}, {}], [{}, {}, {}, {}], [0, 0, "
        "0, 1]]}}\n",
        time, m[0][0], m[1][0], m[2][0], p.x, m[0][1], m[1][1], m[2][1], p.y, m[0][2], m[1][2],
        m[2][2], p.z);
}

std::string keyframes(double last, double step, const std::function<Pose(double)>& pose) {
    std::string text = "  trajectory:\n    keyframes:\n";
    for (int i = 0; i * step <= last + 1e-9; ++i) text += keyframe(i * step, pose(i * step));
    return text;
}

std::vector<ImuReading> read_all(const SceneDesc& scene, double first, double last) {
    const VehicleMotion vehicle(scene);
    const NavigationSensorDesc& sensor = scene.navigation.front();
    return read_imu(sensor, vehicle, readings_around({first, last}, sensor.update_rate, vehicle));
}

// Specific force is 9.81 upwards at rest, in the axes of the IMU.
TEST(Imu, AtRestReadsGravityUpwards) {
    const SceneDesc scene = scene_with(
        "  pose: {position: [3, 2, 1], rotate: [180, 0, 0]}\n",  // y of the camera is down
        "  - {type: imu, pose: {position: [0.3, 0.1, 0], rotate: [0, 0, 90]}}\n");
    for (const ImuReading& reading : read_all(scene, 0, 1)) {
        EXPECT_EQ(reading.rate, Vector3(0.0));
        EXPECT_EQ(reading.gyroscope.value, Vector3(0.0));
        // Up is -y of the camera, whose y is the sensor's x.
        EXPECT_LT(glm::length(reading.accelerometer.value - Vector3(-9.81, 0, 0)), 1e-14);
    }
}

// On a circle, of radius 2 m in 8 s, looking along its way with its y axis up, an IMU 0.5 m nearer
// to the centre reads w^2 1.5 m towards it, and w about y.
TEST(Imu, OnACircleReadsItsCentripetalAcceleration) {
    const double w = 2 * pi / 8;
    const auto on_circle = [&](double time) {
        // z along the way, y up and x inwards.
        const double a = w * time;
        const Vector3 out(std::cos(a), 0, -std::sin(a)), along(-std::sin(a), 0, -std::cos(a));
        return Pose{at_origin_plus(2.0 * out), rotation_of(Matrix3(-out, Vector3(0, 1, 0), along))};
    };
    const SceneDesc scene = scene_with(keyframes(24, 0.02, on_circle),
                                       "  - {type: imu, pose: {position: [0.5, 0, 0]}}\n");
    const auto readings = read_all(scene, 8, 16);
    ASSERT_EQ(readings.size(), 1601U);
    for (const ImuReading& reading : readings) {
        // Between knots h apart the spline's acceleration is off by (w h)^2 / 12 of it, 2e-5.
        EXPECT_LT(glm::length(reading.force - Vector3(w * w * 1.5, 9.81, 0)), 4e-5);
        EXPECT_LT(glm::length(reading.rate - Vector3(0, w, 0)), 1e-11);
        EXPECT_LT(glm::length(reading.motion.velocity -
                              reading.motion.pose.rotation.matrix() * Vector3(0, 0, 1.5 * w)),
                  1e-6);
    }
}

/// A restless dive of 60 s, a pose each second.
Pose dive(double time) {
    const double t = time;
    return {{3 * std::sin(0.4 * t), -2 - std::cos(0.23 * t), 0.3 * t},
            rotation_by({0.4 * std::sin(0.9 * t), 0.15 * t, 0.3 * std::cos(0.6 * t)})};
}

struct NavigationState {
    Vector3 position, velocity;
    Matrix3 rotation;  // world_from_imu
};

/// The states' derivatives from what an IMU reads, as a strapdown navigator has them.
NavigationState change_of(const NavigationState& s, const Vector3& rate, const Vector3& force) {
    const Matrix3 skew(0, rate.z, -rate.y, -rate.z, 0, rate.x, rate.y, -rate.x, 0);
    return {s.velocity, s.rotation * force - Vector3(0, 9.81, 0), s.rotation * skew};
}

NavigationState moved(const NavigationState& s, const NavigationState& change, double step) {
    return {s.position + step * change.position, s.velocity + step * change.velocity,
            s.rotation + step * change.rotation};
}

/// A step of the classical Runge-Kutta method over two readings' intervals.
NavigationState stepped(const NavigationState& s, double step, const ImuReading& begin,
                        const ImuReading& middle, const ImuReading& end) {
    const auto at = [](const NavigationState& state, const ImuReading& r) {
        return change_of(state, r.gyroscope.value, r.accelerometer.value);
    };
    const NavigationState k1 = at(s, begin), k2 = at(moved(s, k1, step / 2), middle),
                          k3 = at(moved(s, k2, step / 2), middle), k4 = at(moved(s, k3, step), end);
    NavigationState next = moved(s, k1, step / 6);
    next = moved(next, k2, step / 3);
    next = moved(next, k3, step / 3);
    return moved(next, k4, step / 6);
}

// A navigator that knows the first pose and velocity alone, and integrates what a clean IMU at 500
// Hz reads, is 1e-6 m and rad from the camera's own path after a minute. Its method's error is that
// of steps of 4 ms to the fourth power.
TEST(Imu, IntegratesToThePathItWasMadeOf) {
    const SceneDesc scene =
        scene_with(keyframes(60, 1, dive),
                   "  - {type: imu, update_rate: 500, pose: {rotate: [20, -70, 130]}}\n");
    const auto readings = read_all(scene, 0, 60);
    ASSERT_EQ(readings.size(), 30'001U);
    const BodyMotion& begin = readings.front().motion;
    NavigationState state{from_origin(begin.pose.position), begin.velocity,
                          begin.pose.rotation.matrix()};
    double worst_position = 0, worst_angle = 0;
    const Trajectory& path = *scene.camera.trajectory->trajectory;
    const Affine& mount = scene.navigation.front().body_from_sensor;
    for (std::size_t i = 0; i + 2 < readings.size(); i += 2) {
        state = stepped(state, 2.0 / 500, readings[i], readings[i + 1], readings[i + 2]);
        const double time = static_cast<double>(readings[i + 2].number) / 500;
        const Affine truth = path.at(time).affine() * mount;
        worst_position = std::max(worst_position, glm::length(state.position - truth.offset()));
        worst_angle = std::max(worst_angle,
                               glm::length(rotation_vector(rotation_of(truth.linear()).inverse() *
                                                           rotation_of(state.rotation))));
    }
    EXPECT_LT(worst_position, 1e-6);
    EXPECT_LT(worst_angle, 1e-6);
    RecordProperty("worst_position_m", fmt::format("{:.3g}", worst_position));
    RecordProperty("worst_angle_rad", fmt::format("{:.3g}", worst_angle));
}

// With a lever arm the specific force has steps where the angular acceleration has: at the poses.
// A navigator whose readings are none of these, but lie at Gauss's nodes between, comes back as
// well.
TEST(Imu, WithALeverArmIntegratesToItsOwnPath) {
    const SceneDesc scene =
        scene_with(keyframes(60, 1, dive), "  - {type: imu, pose: {position: [0.4, -0.3, 0.8]}}\n");
    const VehicleMotion vehicle(scene);
    const NavigationSensorDesc& sensor = scene.navigation.front();
    const auto motion = [&](double t) {
        return vehicle.motion_at(t, sensor.body_from_sensor, sensor.where);
    };
    Vector3 position = from_origin(motion(0).pose.position), velocity = motion(0).velocity;
    // Three nodes on each of 50 parts of a second: right to the sixth power of 0.02 s.
    constexpr double k_part = 0.02;
    const double far = std::sqrt(0.6);
    for (int part = 0; part < 3000; ++part) {
        Vector3 push(0.0), shift(0.0);
        for (const auto& [node, weight] :
             {std::pair{-far, 5.0 / 9}, std::pair{0.0, 8.0 / 9}, std::pair{far, 5.0 / 9}}) {
            const double fraction = 0.5 + 0.5 * node;
            const BodyMotion m = motion((part + fraction) * k_part);
            const Vector3 a =
                m.pose.rotation.matrix() * specific_force(m, 9.81, sensor.up) - Vector3(0, 9.81, 0);
            push += 0.5 * weight * k_part * a;
            shift += 0.5 * weight * k_part * ((1 - fraction) * k_part) * a;
        }
        position += k_part * velocity + shift;
        velocity += push;
    }
    EXPECT_LT(glm::length(position - from_origin(motion(60).pose.position)), 1e-6);
    EXPECT_LT(glm::length(velocity - motion(60).velocity), 1e-7);
}

/// The Allan variance of a series at clusters of `size` readings (IEEE Std 952-1997, annex C), and
/// how many pairs it is the mean of.
struct AllanVariance {
    double value = 0;
    double pairs = 0;
};
AllanVariance allan_variance(const std::vector<double>& series, std::size_t size) {
    std::vector<double> means;
    for (std::size_t begin = 0; begin + size <= series.size(); begin += size) {
        double sum = 0;
        for (std::size_t i = begin; i < begin + size; ++i) sum += series[i];
        means.push_back(sum / static_cast<double>(size));
    }
    AllanVariance result;
    for (std::size_t i = 0; i + 1 < means.size(); ++i)
        result.value += 0.5 * (means[i + 1] - means[i]) * (means[i + 1] - means[i]);
    result.pairs = static_cast<double>(means.size() - 1);
    result.value /= result.pairs;
    return result;
}

// At rest the Allan variance is N^2 / tau + K^2 tau / 3, with the walk's sum over readings instead
// of its integral. Neighbouring pairs share a cluster, so that its relative standard error is at
// most sqrt(3 / pairs); 4 of these are exceeded by one of 36 in 500 seeds.
TEST(Imu, HasTheAllanVarianceOfItsParameters) {
    const SceneDesc scene =
        scene_with("",
                   "  - {type: imu, update_rate: 200, seed: 3, accelerometer_noise_density: 2e-3,\n"
                   "     accelerometer_random_walk: 3e-3, gyroscope_noise_density: 1.7e-4,\n"
                   "     gyroscope_random_walk: 2e-5}\n");
    const auto readings = read_all(scene, 0, 3600);
    const auto& imu = std::get<ImuDesc>(scene.navigation.front().kind);
    const auto check = [&](const TriadDesc& desc,
                           const std::function<Vector3(const ImuReading&)>& of) {
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<double> series;
            for (const ImuReading& reading : readings) series.push_back(of(reading)[axis]);
            for (const std::size_t size : {1U, 20U, 200U, 1000U, 4000U, 16'000U}) {
                const auto m = static_cast<double>(size);
                const double tau = m / 200;
                const double expected =
                    desc.noise_density * desc.noise_density / tau +
                    desc.random_walk * desc.random_walk * tau / 3 * (1 + 0.5 / (m * m));
                const AllanVariance found = allan_variance(series, size);
                EXPECT_NEAR(found.value / expected, 1, 4 * std::sqrt(3 / found.pairs))
                    << "axis " << axis << ", " << tau << " s";
            }
        }
    };
    check(imu.accelerometer, [](const ImuReading& r) { return r.accelerometer.value; });
    check(imu.gyroscope, [](const ImuReading& r) { return r.gyroscope.value; });
}

// A reading depends on its number, the seed and the sensor's name: not on the other readings.
TEST(Imu, ReadsTheSameWhateverElseIsRead) {
    const auto scene = [](const std::string& more) {
        return scene_with(keyframes(4, 0.5, dive),
                          "  - {type: imu, gyroscope_noise_density: 1e-3, gyroscope_random_walk: "
                          "1e-3, accelerometer_noise_density: 1e-2" +
                              more + "}\n");
    };
    const auto all = read_all(scene(""), 0, 4);
    const auto part = read_all(scene(""), 1.9999, 3.0001);
    ASSERT_EQ(part.size(), 203U);
    ASSERT_EQ(part.front().number, 399);
    for (std::size_t i = 0; i < part.size(); ++i) {
        EXPECT_EQ(part[i].gyroscope.value, all[399 + i].gyroscope.value);
        EXPECT_EQ(part[i].gyroscope.bias, all[399 + i].gyroscope.bias);
        EXPECT_EQ(part[i].accelerometer.value, all[399 + i].accelerometer.value);
        EXPECT_NE(part[i].gyroscope.value - part[i].rate, part[i].gyroscope.bias);
    }
    for (const char* other : {", seed: 1", ", name: other"})
        EXPECT_NE(read_all(scene(other), 0, 4)[7].gyroscope.value, all[7].gyroscope.value);
}

TEST(Imu, ReadingsAreScaledMisalignedRoundedAndClipped) {
    TriadDesc desc;
    desc.scale = {1.1, 0.9, 1};
    desc.misalignment = {0.01, 0.02, 0.03};
    desc.bias = {0.5, 0, -0.25};
    const Vector3 value = TriadErrors(desc, 100, 1, 0).read({10, 20, 30}, 0).value;
    EXPECT_LT(glm::length(value - Vector3(11.5, 18.1, 30 + 0.2 + 0.6 - 0.25)), 1e-13);
    desc.range = 16;
    desc.bits = 8;  // steps of 1/8, from -16 to 15.875
    const Vector3 digital = TriadErrors(desc, 100, 1, 0).read({-1, 30, -40}, 0).value;
    EXPECT_EQ(digital, Vector3(-0.625, 15.875, -16));
}

TEST(Imu, IsRefusedWhereVelocitiesJump) {
    const SceneDesc scene =
        scene_with(keyframes(2, 1, dive) + "    interpolation: linear\n", "  - {type: imu}\n");
    const std::string message = test::message_of<InputError>([&] { read_all(scene, 0, 2); });
    EXPECT_NE(message.find("sensors[0]"), std::string::npos) << message;
    EXPECT_NE(message.find("write interpolation: smooth"), std::string::npos) << message;
}

}  // namespace
}  // namespace uw
