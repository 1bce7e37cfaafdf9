#include "render/navigation/imu.h"

#include <variant>

#include "core/base/error.h"

namespace uw {

namespace {

constexpr std::uint64_t k_accelerometer = 0, k_gyroscope = 1;  // of noise_key

}  // namespace

Vector3 specific_force(const BodyMotion& motion, double gravity, const Vector3& up) {
    return glm::transpose(motion.pose.rotation.matrix()) * (motion.acceleration + gravity * up);
}

std::vector<ImuReading> read_imu(const NavigationSensorDesc& sensor, const VehicleMotion& vehicle,
                                 const ReadingRange& range) {
    const auto& imu = std::get<ImuDesc>(sensor.kind);
    const std::int64_t first = first_reading(sensor.update_rate, vehicle);
    TriadErrors accelerometer(imu.accelerometer, sensor.update_rate,
                              noise_key(sensor, k_accelerometer), first);
    TriadErrors gyroscope(imu.gyroscope, sensor.update_rate, noise_key(sensor, k_gyroscope), first);
    std::vector<ImuReading> readings;
    for (std::int64_t n = range.first; n <= range.last; ++n) {
        throw_if_stopped();
        ImuReading reading;
        reading.number = n;
        reading.motion = vehicle.motion_at(static_cast<double>(n) / sensor.update_rate,
                                           sensor.body_from_sensor, sensor.where);
        reading.rate = reading.motion.angular_velocity;
        reading.force = specific_force(reading.motion, imu.gravity, sensor.up);
        reading.gyroscope = gyroscope.read(reading.rate, n);
        reading.accelerometer = accelerometer.read(reading.force, n);
        readings.push_back(reading);
    }
    return readings;
}

}  // namespace uw
