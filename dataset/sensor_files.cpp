#include "dataset/sensor_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <variant>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/json.h"
#include "dataset/frame_stamps.h"
#include "render/image_scene.h"
#include "render/navigation/imu.h"
#include "render/navigation/sensor_record.h"
#include "render/navigation/vehicle_motion.h"

namespace uw {

const char* const k_euroc_truth_header =
    "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
    "q_RS_z [], v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1],"
    " b_w_RS_S_y [rad s^-1], b_w_RS_S_z [rad s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], "
    "b_a_RS_S_z [m s^-2]\n";

namespace {

Json matrix_json(const Affine& map) {
    Json rows = Json::array();
    for (int row = 0; row < 3; ++row)
        rows.push_back(
            {map.linear()[0][row], map.linear()[1][row], map.linear()[2][row], map.offset()[row]});
    rows.push_back({0.0, 0.0, 0.0, 1.0});
    return rows;
}

/// The four numbers of a row with the sign that makes w >= 0.
Rotation upper(const Rotation& q) {
    return q.w < 0 ? Rotation{-q.w, -q.x, -q.y, -q.z} : q;
}

/// The readings of a sensor, or poses, `rate` per second, that are written of a span.
class ReadingTimes {
  public:
    ReadingTimes(const SceneDesc& whole, const TimeRange& span, double rate,
                 const std::string& subject)
        : range_(readings_around(span, rate, VehicleMotion(whole))), rate_(rate) {
        if (range_.empty())
            throw InputError(fmt::format(
                "{}: the vehicle has no pose from {:g} to {:g} s at which it would be read; give "
                "other times",
                subject, span.first, span.last));
        const double count = static_cast<double>(range_.last - range_.first) + 1;
        if (count > k_max_readings)
            throw InputError(fmt::format(
                "{}: would be read {:.0f} times from {:g} to {:g} s, and at most {:.0f} are "
                "written at once; give a shorter time or fewer per second",
                subject, count, span.first, span.last, k_max_readings));
    }

    const ReadingRange& range() const { return range_; }
    double time(std::int64_t number) const { return static_cast<double>(number) / rate_; }

  private:
    ReadingRange range_;
    double rate_;
};

std::string record_csv(const SensorRecord& record, double rate, const FrameStamps& stamps) {
    std::string text = fmt::format("# {}\nstamp_ns,time_s", record.note);
    for (const std::string& column : record.columns) text += "," + column;
    text += "\n";
    const std::size_t columns = record.columns.size();
    for (std::size_t row = 0; row < record.numbers.size(); ++row) {
        throw_if_stopped();
        const double time = static_cast<double>(record.numbers[row]) / rate;
        text += fmt::format("{},{}", stamps.at(std::nullopt, time), time);
        for (std::size_t i = 0; i < columns; ++i) {
            const double value = record.values[row * columns + i];
            text += std::isfinite(value) ? fmt::format(",{}", value) : ",";
        }
        text += "\n";
    }
    return text;
}

/// The noise of an IMU in the words of Kalibr and EuRoC.
std::string noise_yaml(const ImuDesc& imu) {
    return fmt::format(
        "gyroscope_noise_density: {}\ngyroscope_random_walk: {}\n"
        "accelerometer_noise_density: {}\naccelerometer_random_walk: {}\n",
        imu.gyroscope.noise_density, imu.gyroscope.random_walk, imu.accelerometer.noise_density,
        imu.accelerometer.random_walk);
}

std::string kalibr_imu_yaml(const NavigationSensorDesc& sensor, const ImuDesc& imu) {
    return fmt::format("rostopic: {}\nupdate_rate: {}\n", imu.rostopic, sensor.update_rate) +
           noise_yaml(imu);
}

/// The rate of the trajectory's poses [Hz].
double pose_rate(const SceneDesc& whole, double wanted) {
    if (wanted > 0) return wanted;
    double rate = 0;
    for (const NavigationSensorDesc& sensor : whole.navigation)
        rate = std::max(rate, sensor.update_rate);
    return rate > 0 ? rate : whole.render.fps;
}

void add_trajectory(const SceneDesc& whole, const TimeRange& span, double rate,
                    const FrameStamps& stamps, std::vector<NamedText>& files) {
    const VehicleMotion vehicle(whole);
    const ReadingTimes times(whole, span, rate, "trajectory.tum");
    std::string tum = "# world from body\n# timestamp tx ty tz qx qy qz qw\n";
    std::string csv = k_euroc_truth_header;
    for (std::int64_t n = times.range().first; n <= times.range().last; ++n) {
        throw_if_stopped();
        const double time = times.time(n);
        const std::int64_t stamp = stamps.at(std::nullopt, time);
        const auto [p, turned] = vehicle.pose_at(time, Affine());
        const Rotation q = upper(turned);
        tum += fmt::format("{} {} {} {} {} {} {} {}\n", seconds_text(stamp), p.x, p.y, p.z, q.x,
                           q.y, q.z, q.w);
        if (!vehicle.is_smooth()) continue;
        const Vector3 v = vehicle.motion_at(time, Affine(), "trajectory.csv").velocity;
        csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},0,0,0,0,0,0\n", stamp, p.x, p.y, p.z,
                           q.w, q.x, q.y, q.z, v.x, v.y, v.z);
    }
    files.push_back({"trajectory.tum", std::move(tum)});
    if (vehicle.is_smooth()) files.push_back({"trajectory.csv", std::move(csv)});
}

std::string mounts_json_text(const SceneDesc& whole) {
    Json sensors = Json::array(), cameras = Json::array();
    for (const NavigationSensorDesc& sensor : whole.navigation)
        sensors.push_back({{"name", sensor.name},
                           {"type", type_word(sensor)},
                           {"update_rate", sensor.update_rate},
                           {"body_from_sensor", matrix_json(sensor.body_from_sensor)}});
    for (std::size_t i = 0; i < std::max<std::size_t>(whole.cameras.size(), 1); ++i)
        cameras.push_back({{"name", whole.cameras.empty() ? "" : whole.cameras[i].name},
                           {"body_from_camera", matrix_json(body_from_camera(whole, i))}});
    return json_text({{"sensors", std::move(sensors)}, {"cameras", std::move(cameras)}});
}

const NavigationSensorDesc* first_imu(const SceneDesc& scene) {
    const auto found = std::ranges::find_if(scene.navigation, [](const auto& sensor) {
        return std::holds_alternative<ImuDesc>(sensor.kind);
    });
    return found == scene.navigation.end() ? nullptr : &*found;
}

std::string euroc_imu_yaml(const NavigationSensorDesc& sensor, const Affine& body_from_world_body) {
    const auto& imu = std::get<ImuDesc>(sensor.kind);
    return "# The body is imu0.\nsensor_type: imu\ncomment: computed from the trajectory\n" +
           euroc_pose_yaml(body_from_world_body * sensor.body_from_sensor) +
           fmt::format("rate_hz: {}\n", sensor.update_rate) + noise_yaml(imu);
}

std::string euroc_imu_csv(const std::vector<ImuReading>& readings, double rate,
                          const FrameStamps& stamps) {
    std::string text =
        "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
        "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n";
    for (const ImuReading& reading : readings) {
        const Vector3& w = reading.gyroscope.value;
        const Vector3& a = reading.accelerometer.value;
        const std::int64_t stamp =
            stamps.at(std::nullopt, static_cast<double>(reading.number) / rate);
        text +=
            fmt::format("{},{},{},{},{},{},{}\n", euroc_stamp(stamp), w.x, w.y, w.z, a.x, a.y, a.z);
    }
    return text;
}

std::string euroc_truth_csv(const std::vector<ImuReading>& readings, double rate,
                            const FrameStamps& stamps) {
    std::string text = k_euroc_truth_header;
    for (const ImuReading& reading : readings) {
        const BodyMotion& m = reading.motion;
        const Point3& p = m.pose.position;
        const Rotation q = upper(m.pose.rotation);
        const Vector3 &v = m.velocity, &bw = reading.gyroscope.bias,
                      &ba = reading.accelerometer.bias;
        const std::int64_t stamp =
            stamps.at(std::nullopt, static_cast<double>(reading.number) / rate);
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                            euroc_stamp(stamp), p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z,
                            bw.x, bw.y, bw.z, ba.x, ba.y, ba.z);
    }
    return text;
}

void check_stamps_of(const ReadingTimes& times, const FrameStamps& stamps,
                     const NavigationSensorDesc& imu) {
    const std::int64_t first = stamps.at(std::nullopt, times.time(times.range().first));
    const std::int64_t last = stamps.at(std::nullopt, times.time(times.range().last));
    if (euroc_stamp(last) - euroc_stamp(first) != last - first)
        throw InputError(fmt::format(
            "{}: EuRoC's stamps have 19 digits, but those of the readings, from {} to {} ns, are "
            "on both sides of 10^18; give the trajectory other times",
            imu.where, first, last));
}

}  // namespace

std::string euroc_pose_yaml(const Affine& body_from_sensor) {
    std::string text = "T_BS:\n  cols: 4\n  rows: 4\n  data: [";
    const Matrix3& linear = body_from_sensor.linear();
    for (int row = 0; row < 3; ++row)
        text += fmt::format("{}, {}, {}, {},\n         ", linear[0][row], linear[1][row],
                            linear[2][row], body_from_sensor.offset()[row]);
    return text + "0.0, 0.0, 0.0, 1.0]\n";
}

std::vector<NamedText> sensor_files(const SceneDesc& whole, const TimeRange& span, double rate) {
    const FrameStamps stamps(whole);
    std::vector<NamedText> files;
    for (const NavigationSensorDesc& sensor : whole.navigation) {
        const ReadingTimes times(whole, span, sensor.update_rate, sensor.where);
        const SensorRecord record = record_sensor(whole, sensor, times.range());
        files.push_back({sensor.name + ".csv", record_csv(record, sensor.update_rate, stamps)});
        if (const auto* const imu = std::get_if<ImuDesc>(&sensor.kind))
            files.push_back({sensor.name + ".yaml", kalibr_imu_yaml(sensor, *imu)});
    }
    add_trajectory(whole, span, pose_rate(whole, rate), stamps, files);
    files.push_back({"sensors.json", mounts_json_text(whole)});
    return files;
}

bool has_imu(const SceneDesc& scene) {
    return first_imu(scene) != nullptr;
}

std::vector<NamedText> euroc_imu_files(const SceneDesc& whole, const TimeRange& span) {
    const NavigationSensorDesc* const body = first_imu(whole);
    if (body == nullptr) return {};
    const FrameStamps stamps(whole);
    const VehicleMotion vehicle(whole);
    std::vector<NamedText> files;
    for (const NavigationSensorDesc& sensor : whole.navigation) {
        if (!std::holds_alternative<ImuDesc>(sensor.kind)) continue;
        const ReadingTimes times(whole, span, sensor.update_rate, sensor.where);
        check_stamps_of(times, stamps, sensor);
        const std::vector<ImuReading> readings = read_imu(sensor, vehicle, times.range());
        const std::string folder = fmt::format("imu{}/", files.size() / 2);
        files.push_back({folder + "data.csv", euroc_imu_csv(readings, sensor.update_rate, stamps)});
        files.push_back(
            {folder + "sensor.yaml", euroc_imu_yaml(sensor, body->body_from_sensor.inverse())});
    }
    const ReadingTimes times(whole, span, body->update_rate, body->where);
    const std::string folder = "state_groundtruth_estimate0/";
    files.push_back({folder + "data.csv", euroc_truth_csv(read_imu(*body, vehicle, times.range()),
                                                          body->update_rate, stamps)});
    files.push_back({folder + "sensor.yaml",
                     "# The body is imu0.\nsensor_type: visual-inertial\ncomment: computed from "
                     "the trajectory, without error\n" +
                         euroc_pose_yaml(Affine())});
    return files;
}

TimeRange span_of_frames(const DatasetDefinition& definition, const SceneDesc& whole) {
    if (!has_motion(whole)) return {0, 0};
    TimeRange span{std::numeric_limits<double>::infinity(),
                   -std::numeric_limits<double>::infinity()};
    for (const std::optional<int>& frame : definition.frames) {
        const double time = frame ? time_of_frame(whole, *frame) : first_time(whole);
        span = {std::min(span.first, time), std::max(span.last, time)};
    }
    return span;
}

std::string imu_mounts_file(const DatasetDefinition& definition, std::size_t draw) {
    return definition.folder(draw) + "views/imu_from_cameras.json";
}

std::string imu_mounts_text(const DatasetDefinition& definition, const SceneDesc& whole) {
    const NavigationSensorDesc* const imu = first_imu(whole);
    Json list = Json::array();
    if (imu == nullptr) return json_text(list);
    const Affine imu_from_body = imu->body_from_sensor.inverse();
    for (const std::string& name : definition.cameras) {
        const auto found = std::ranges::find(whole.cameras, name, &RigCameraDesc::name);
        const auto place = found == whole.cameras.end() ? 0 : found - whole.cameras.begin();
        list.push_back(
            matrix_json(imu_from_body * body_from_camera(whole, static_cast<std::size_t>(place))));
    }
    return json_text(list);
}

std::vector<Affine> read_imu_mounts(const std::filesystem::path& file, std::size_t cameras) {
    std::ifstream in = open_own_file(file);
    if (!in) throw IoError(fmt::format("{}: cannot be read", file.string()));
    try {
        std::vector<Affine> mounts;
        for (const Json& rows : Json::parse(in)) {
            Matrix3 linear(1.0);
            Vector3 offset(0.0);
            for (int row = 0; row < 3; ++row) {
                const Json& numbers = rows.at(static_cast<std::size_t>(row));
                for (int column = 0; column < 3; ++column)
                    numbers.at(static_cast<std::size_t>(column)).get_to(linear[column][row]);
                numbers.at(3).get_to(offset[row]);
            }
            mounts.emplace_back(linear, offset);
        }
        if (mounts.size() == cameras) return mounts;
    } catch (const Json::exception&) {
        // Reported below.
    }
    throw InputError(
        fmt::format("{}: is not what uwvdb wrote there; make the set again", file.string()));
}

}  // namespace uw
