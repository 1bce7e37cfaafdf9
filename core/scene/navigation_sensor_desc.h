#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/base/vector_math.h"
#include "core/scene/config_value.h"
#include "core/scene/meter_desc.h"
#include "core/scene/scene_context.h"

namespace uw {

/// The sensors of a vehicle as inert data (docs/scene-file.md): those that record over time what
/// follows from its motion and from where it is.

/// The errors of a sensor with three axes. A reading is M x + b + n, rounded and clipped: M is
/// lower triangular, with `scale` on its diagonal (Rehder et al. 2016, "Extending kalibr", ICRA,
/// equation 3); b is the bias, a random walk; n is white noise. Units are those of x.
struct TriadDesc {
    double noise_density = 0;       ///< of n [unit / sqrt(Hz)]
    double random_walk = 0;         ///< of b [unit / s / sqrt(Hz)]
    Vector3 scale{1.0};             ///< M_xx, M_yy, M_zz
    Vector3 misalignment{0.0};      ///< M_yx, M_zx, M_zy
    Vector3 bias{0.0};              ///< b at the first reading
    std::optional<double> range{};  ///< readings lie within +-range; none: unlimited
    std::optional<int> bits{};      ///< of the numbers that span the range; none: not rounded
};

/// The errors of a sensor with one number: a reading is x + bias + noise, rounded.
struct ScalarErrorDesc {
    double noise = 0;       ///< standard deviation of each reading
    double bias = 0;        ///< constant
    double resolution = 0;  ///< the step of readings; 0: not rounded
};

/// An inertial measurement unit: specific force [m/s^2] and angular rate [rad/s] in its axes.
struct ImuDesc {
    TriadDesc accelerometer, gyroscope;
    double gravity = 9.81;          ///< [m/s^2], against `up`
    std::string rostopic{"/imu0"};  ///< for Kalibr's imu.yaml
};

/// A pressure gauge: the absolute pressure of the water above it and of the air [Pa].
struct PressureDesc {
    ScalarErrorDesc error;                  ///< [Pa]
    double atmospheric_pressure = 101'325;  ///< at the water's surface [Pa]
    double gravity = 9.81;                  ///< [m/s^2]
    /// The water's height above that of the scene: a sin(2 pi (t / period + phase)) at time t.
    struct Tide {
        double amplitude = 0;  ///< [m]
        double period = 0;     ///< [s], > 0
        double phase = 0;      ///< of a period, at the scene's time 0
    };
    std::optional<Tide> tide{};
};

/// Distances that sound can measure.
struct EchoRangeDesc {
    double nearest = 0;   ///< [m], >= 0
    double farthest = 0;  ///< [m], > nearest
    double steepest = 0;  ///< angle of incidence beyond which no echo returns [degrees], 0..90
};

/// A Doppler velocity log: four beams around the sensor's z axis, each of which measures distance
/// and the component of velocity along it.
struct DvlDesc {
    double beam_angle = 30;    ///< between the beams and the axis [degrees], 0..90
    double azimuth = 45;       ///< of the first beam, from x towards y [degrees]; then 90 more each
    ScalarErrorDesc velocity;  ///< of each beam [m/s]
    ScalarErrorDesc range;     ///< of each beam [m]
    double dropout = 0;        ///< probability that a beam is lost, 0..1
    EchoRangeDesc reach{0.2, 100, 75};
};

/// A sonar that measures the distance to the nearest surface within its beam.
struct AltimeterDesc {
    double beam = 0;        ///< full angle of the beam around the sensor's z axis [degrees], 0..90
    ScalarErrorDesc error;  ///< [m]
    EchoRangeDesc reach{0.2, 100, 90};
};

/// A magnetometer [T].
struct MagnetometerDesc {
    TriadDesc error;
    Vector3 field{0.0};  ///< of the Earth, world [T]
};

/// A sensor of a vehicle.
struct NavigationSensorDesc {
    using Kind = std::variant<ImuDesc, PressureDesc, DvlDesc, AltimeterDesc, MagnetometerDesc>;

    std::string name;  ///< unique among all sensors of the scene
    Kind kind;
    /// Rigid. The body is what the trajectory moves: the rig or the camera; without a trajectory
    /// the camera, or the world in a scene with a rig.
    Affine body_from_sensor;
    double update_rate = 0;  ///< [Hz], > 0; reading n is at n / update_rate [s]
    std::uint64_t seed = 0;  ///< of all noise, with the name
    Vector3 up{0, 1, 0};     ///< world, unit
    SourceLocation where;
};

/// The word for a kind of sensor, as `type` has it: "imu".
const char* type_word(const NavigationSensorDesc& sensor);

/// `sensors`: light meters, and the sensors of the vehicle.
void read_sensors(const ConfigValue& value, const SceneContext& context,
                  std::vector<MeterDesc>& meters, std::vector<NavigationSensorDesc>& navigation);

}  // namespace uw
