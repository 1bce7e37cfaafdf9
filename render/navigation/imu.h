#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/navigation_sensor_desc.h"
#include "render/navigation/sensor_errors.h"
#include "render/navigation/vehicle_motion.h"

namespace uw {

/// A reading of an IMU in its axes, with the truth.
struct ImuReading {
    std::int64_t number = 0;  // at number / update_rate [s]
    BodyMotion motion;        // of the IMU
    Vector3 rate{0.0};        // true angular rate [rad/s]
    Vector3 force{0.0};       // true specific force [m/s^2]
    TriadReading gyroscope, accelerometer;
};

/// The specific force R^T (a + g up) [m/s^2] in the axes of an IMU that moves like this: what an
/// accelerometer measures, g upwards at rest.
Vector3 specific_force(const BodyMotion& motion, double gravity, const Vector3& up);

/// The readings of an IMU: angular rate and specific force follow from the exact derivatives of the
/// vehicle's splines. Each depends on its number alone, whichever others are read. Throws as
/// VehicleMotion::motion_at. Precondition: the sensor is an IMU.
std::vector<ImuReading> read_imu(const NavigationSensorDesc& sensor, const VehicleMotion& vehicle,
                                 const ReadingRange& range);

}  // namespace uw
