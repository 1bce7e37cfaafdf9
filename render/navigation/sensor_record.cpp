#include "render/navigation/sensor_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>

#include "core/base/error.h"
#include "render/navigation/echo_sounding.h"
#include "render/navigation/imu.h"
#include "render/navigation/pressure.h"
#include "render/navigation/sensor_errors.h"

namespace uw {

namespace {

constexpr double k_none = std::numeric_limits<double>::quiet_NaN();

/// Makes the record of one kind of sensor or another.
class Recorder {
  public:
    Recorder(const SceneDesc& whole, const NavigationSensorDesc& sensor, const ReadingRange& range)
        : whole_(whole), sensor_(sensor), range_(range), vehicle_(whole) {}

    SensorRecord operator()(const ImuDesc& /*imu*/) {
        SensorRecord record{
            "angular rate w in rad/s, specific force a in m/s^2, biases bw and ba likewise",
            {"wx", "wy", "wz", "ax", "ay", "az", "wx_true", "wy_true", "wz_true", "ax_true",
             "ay_true", "az_true", "bwx_true", "bwy_true", "bwz_true", "bax_true", "bay_true",
             "baz_true"},
            {},
            {}};
        for (const ImuReading& r : read_imu(sensor_, vehicle_, range_)) {
            const auto& [w, bw] = r.gyroscope;
            const auto& [a, ba] = r.accelerometer;
            record.add(r.number,
                       {w.x, w.y, w.z, a.x, a.y, a.z, r.rate.x, r.rate.y, r.rate.z, r.force.x,
                        r.force.y, r.force.z, bw.x, bw.y, bw.z, ba.x, ba.y, ba.z});
        }
        return record;
    }

    SensorRecord operator()(const PressureDesc& desc) {
        SensorRecord record{"absolute pressure in Pa, depth below the water's surface in m",
                            {"pressure", "depth", "pressure_true", "depth_true"},
                            {},
                            {}};
        const WaterColumn column(whole_.water.salinity, whole_.water.temperature, desc.gravity);
        const WaterSurfaceDesc& surface = *whole_.water.surface;
        const std::uint64_t key = noise_key(sensor_, 0);
        for_each_reading([&](std::int64_t n, double time) {
            const Point3 position = pose_at(time).position;
            const double depth =
                tide_at(desc, time) - glm::dot(position - surface.point, surface.normal);
            const double truth = desc.atmospheric_pressure + column.pressure_at(depth);
            PathRandom random = numbers_of_reading(key, n);
            const double reading = scalar_reading(truth, desc.error, random);
            const double read_depth =
                desc.gravity > 0 ? column.depth_at(reading - desc.atmospheric_pressure) : k_none;
            record.add(n, {reading, read_depth, truth, depth});
        });
        return record;
    }

    SensorRecord operator()(const DvlDesc& desc) {
        SensorRecord record{
            "velocity v over the bottom in the sensor's axes in m/s, bottom lock (three beams) 1 "
            "or 0, velocity along each beam in m/s, distance along it in m",
            {"vx",         "vy",          "vz",          "lock",        "beam1",      "beam2",
             "beam3",      "beam4",       "range1",      "range2",      "range3",     "range4",
             "vx_true",    "vy_true",     "vz_true",     "beam1_true",  "beam2_true", "beam3_true",
             "beam4_true", "range1_true", "range2_true", "range3_true", "range4_true"},
            {},
            {}};
        EchoSurfaces surfaces(whole_, sensor_.where);
        const std::array<Vector3, 4> beams = beam_directions(desc);
        const std::uint64_t key = noise_key(sensor_, 0);
        for_each_reading([&](std::int64_t n, double time) {
            const BodyMotion motion =
                vehicle_.motion_at(time, sensor_.body_from_sensor, sensor_.where);
            const Matrix3 world_from_sensor = motion.pose.rotation.matrix();
            const Vector3 velocity = glm::transpose(world_from_sensor) * motion.velocity;
            const Surfaces& bottom = surfaces.at(time);
            std::array<std::optional<double>, 4> along{};
            std::array<double, 4> read_range{}, true_range{}, true_along{};
            PathRandom random = numbers_of_reading(key, n);
            for (std::size_t i = 0; i < beams.size(); ++i) {
                const Echo echo = echo_along({motion.pose.position, world_from_sensor * beams[i]},
                                             bottom, desc.reach);
                true_range[i] = echo.distance;
                true_along[i] = glm::dot(velocity, beams[i]);
                // Always the same numbers for a beam, whatever becomes of the others.
                const bool is_dropped = random.next() < desc.dropout;
                const double range = scalar_reading(echo.distance, desc.range, random);
                const double speed = scalar_reading(true_along[i], desc.velocity, random);
                const bool is_lost = is_dropped || !echo.returns;
                read_range[i] = is_lost ? k_none : range;
                if (!is_lost) along[i] = speed;
            }
            const auto measured = velocity_of_beams(beams, along);
            const Vector3 v = measured.value_or(Vector3(k_none));
            const auto& b = along;
            const auto& t = true_along;
            const auto& r = read_range;
            const auto& d = true_range;
            record.add(n, {v.x,
                           v.y,
                           v.z,
                           measured ? 1.0 : 0.0,
                           b[0].value_or(k_none),
                           b[1].value_or(k_none),
                           b[2].value_or(k_none),
                           b[3].value_or(k_none),
                           r[0],
                           r[1],
                           r[2],
                           r[3],
                           velocity.x,
                           velocity.y,
                           velocity.z,
                           t[0],
                           t[1],
                           t[2],
                           t[3],
                           d[0],
                           d[1],
                           d[2],
                           d[3]});
        });
        return record;
    }

    SensorRecord operator()(const AltimeterDesc& desc) {
        SensorRecord record{
            "distance to the nearest surface in the beam in m", {"range", "range_true"}, {}, {}};
        EchoSurfaces surfaces(whole_, sensor_.where);
        const std::vector<Vector3> rays = altimeter_directions(desc);
        const std::uint64_t key = noise_key(sensor_, 0);
        for_each_reading([&](std::int64_t n, double time) {
            const Pose pose = pose_at(time);
            const Matrix3 world_from_sensor = pose.rotation.matrix();
            const Surfaces& bottom = surfaces.at(time);
            double first = std::numeric_limits<double>::infinity(), nearest = first;
            for (const Vector3& ray : rays) {
                const Echo echo =
                    echo_along({pose.position, world_from_sensor * ray}, bottom, desc.reach);
                nearest = std::min(nearest, echo.distance);
                if (echo.returns) first = std::min(first, echo.distance);
            }
            PathRandom random = numbers_of_reading(key, n);
            const double reading = scalar_reading(first, desc.error, random);
            record.add(n, {std::isfinite(first) ? reading : k_none, nearest});
        });
        return record;
    }

    SensorRecord operator()(const MagnetometerDesc& desc) {
        SensorRecord record{"magnetic field b in the sensor's axes in T, bias likewise",
                            {"bx", "by", "bz", "bx_true", "by_true", "bz_true", "biasx_true",
                             "biasy_true", "biasz_true"},
                            {},
                            {}};
        TriadErrors errors(desc.error, sensor_.update_rate, noise_key(sensor_, 0),
                           first_reading(sensor_.update_rate, vehicle_));
        for_each_reading([&](std::int64_t n, double time) {
            const Vector3 truth = glm::transpose(pose_at(time).rotation.matrix()) * desc.field;
            const auto [b, bias] = errors.read(truth, n);
            record.add(n, {b.x, b.y, b.z, truth.x, truth.y, truth.z, bias.x, bias.y, bias.z});
        });
        return record;
    }

  private:
    template <class Take>
    void for_each_reading(const Take& take) const {
        for (std::int64_t n = range_.first; n <= range_.last; ++n) {
            throw_if_stopped();
            take(n, static_cast<double>(n) / sensor_.update_rate);
        }
    }

    Pose pose_at(double time) const { return vehicle_.pose_at(time, sensor_.body_from_sensor); }

    const SceneDesc& whole_;
    const NavigationSensorDesc& sensor_;
    ReadingRange range_;
    VehicleMotion vehicle_;
};

}  // namespace

SensorRecord record_sensor(const SceneDesc& whole, const NavigationSensorDesc& sensor,
                           const ReadingRange& range) {
    return std::visit(Recorder(whole, sensor, range), sensor.kind);
}

}  // namespace uw
