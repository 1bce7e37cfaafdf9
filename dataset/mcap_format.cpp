#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/image/image_file.h"
#include "core/image/png_file.h"
#include "dataset/formats.h"
#include "dataset/frame_stamps.h"
#include "dataset/mcap_writer.h"
#include "dataset/ros2_messages.h"
#include "dataset/sensor_files.h"
#include "render/image_scene.h"
#include "render/navigation/echo_sounding.h"
#include "render/navigation/sensor_record.h"
#include "render/navigation/vehicle_motion.h"

namespace uw {

namespace {

constexpr const char* k_world_frame = "world";
constexpr const char* k_body_frame = "body";

/// A series of messages of one type.
struct RosStream {
    RosType type = RosType::imu;
    std::string topic;
};

/// The messages of a draw that follow from its scene alone, by their times, and what the images of
/// its cameras are called. This is a file of the draw (readings_file), which the bag is made of.
struct RosReadings {
    struct Message {
        std::int64_t stamp = 0;
        std::uint16_t stream = 0;
        std::string data;
    };
    std::vector<std::string> mosaics;  // of cameras: "rggb"; empty: none
    std::vector<RosStream> streams;
    std::vector<Message> messages;
};

/// A name as ROS allows it in topics.
std::string ros_word(std::string name) {
    std::ranges::replace(name, '-', '_');
    if (!name.empty() && name.front() >= '0' && name.front() <= '9') name.insert(0, "_");
    return name;
}

std::string camera_frame(std::size_t camera) {
    return fmt::format("cam{}", camera);
}

std::string topic_of(const NavigationSensorDesc& sensor) {
    if (const auto* const imu = std::get_if<ImuDesc>(&sensor.kind)) return imu->rostopic;
    return "/" + ros_word(sensor.name);
}

/// The pattern of a camera's raw images; empty for images without.
std::string mosaic_of(const CameraDesc& camera) {
    if (!camera.sensor || !is_bayer(camera.sensor->mosaic)) return {};
    const DevelopmentDesc& image = camera.sensor->image;
    if (!image.is_raw && image.demosaic) return {};
    switch (camera.sensor->mosaic) {
        case SensorMosaic::bggr:
            return "bggr";
        case SensorMosaic::grbg:
            return "grbg";
        case SensorMosaic::gbrg:
            return "gbrg";
        default:
            return "rggb";
    }
}

/// The places in the scene of a set's cameras.
std::vector<std::size_t> places_of_cameras(const DatasetDefinition& definition,
                                           const SceneDesc& scene) {
    std::vector<std::size_t> places;
    for (const std::string& name : definition.cameras) {
        const auto found = std::ranges::find(scene.cameras, name, &RigCameraDesc::name);
        places.push_back(found == scene.cameras.end()
                             ? 0
                             : static_cast<std::size_t>(found - scene.cameras.begin()));
    }
    return places;
}

/// Makes the messages of a draw's sensors and of its motion.
class ReadingsMaker {
  public:
    ReadingsMaker(const DatasetDefinition& definition, const SceneDesc& whole)
        : definition_(definition), whole_(whole), stamps_(whole), vehicle_(whole) {}

    RosReadings make() {
        for (const std::size_t place : places_of_cameras(definition_, whole_))
            readings_.mosaics.push_back(
                mosaic_of(whole_.cameras.empty() ? whole_.camera : whole_.cameras[place].camera));
        const std::uint16_t fixed = add_stream(RosType::transforms, "/tf_static");
        add_motion();
        for (const NavigationSensorDesc& sensor : whole_.navigation) add_sensor(sensor);
        std::ranges::stable_sort(readings_.messages, {}, &RosReadings::Message::stamp);
        add_mounts(fixed);
        return std::move(readings_);
    }

  private:
    std::uint16_t add_stream(RosType type, std::string topic) {
        readings_.streams.push_back({type, std::move(topic)});
        return static_cast<std::uint16_t>(readings_.streams.size() - 1);
    }

    void add(std::uint16_t stream, std::int64_t stamp, std::string data) {
        readings_.messages.push_back({stamp, stream, std::move(data)});
    }

    static std::int64_t checked(std::int64_t stamp) {
        constexpr std::int64_t k_end = 2'147'483'648'000'000'000;  // of seconds in 32 bits
        if (stamp < 0 || stamp >= k_end)
            throw InputError(fmt::format(
                "--format mcap: ROS has no stamp of {} ns, which is before 1970 or after 2038; "
                "give the trajectory another time, or leave the format out",
                stamp));
        return stamp;
    }

    /// The pose of the body, and its motion, at each frame.
    void add_motion() {
        const std::uint16_t moving = add_stream(RosType::transforms, "/tf");
        std::optional<std::uint16_t> odometry;
        if (vehicle_.is_smooth()) odometry = add_stream(RosType::odometry, "/odometry");
        for (const std::optional<int>& frame : definition_.frames) {
            throw_if_stopped();
            const double time = !has_motion(whole_) ? frame.value_or(0) / whole_.render.fps
                                : frame             ? time_of_frame(whole_, *frame)
                                                    : first_time(whole_);
            const std::int64_t stamp = checked(stamps_.at(frame, time));
            const RosHeader header{stamp, k_world_frame};
            const RosTransform body{header, k_body_frame, vehicle_.pose_at(time, Affine())};
            add(moving, stamp, ros_transforms(std::span(&body, 1)));
            if (odometry)
                add(*odometry, stamp,
                    ros_odometry(header, k_body_frame,
                                 vehicle_.motion_at(time, Affine(), "--format mcap")));
        }
    }

    /// Where cameras and sensors are on the body, before all else.
    void add_mounts(std::uint16_t stream) {
        const std::int64_t stamp = readings_.messages.front().stamp;
        const RosHeader header{stamp, k_body_frame};
        std::vector<RosTransform> mounts;
        const std::vector<std::size_t> places = places_of_cameras(definition_, whole_);
        for (std::size_t i = 0; i < places.size(); ++i)
            mounts.push_back(
                {header, camera_frame(i), pose_of(body_from_camera(whole_, places[i]))});
        for (const NavigationSensorDesc& sensor : whole_.navigation)
            mounts.push_back({header, ros_word(sensor.name), pose_of(sensor.body_from_sensor)});
        readings_.messages.insert(readings_.messages.begin(),
                                  {stamp, stream, ros_transforms(mounts)});
    }

    void add_sensor(const NavigationSensorDesc& sensor) {
        const TimeRange span = span_of_frames(definition_, whole_);
        const SensorRecord record =
            record_sensor(whole_, sensor, readings_around(span, sensor.update_rate, vehicle_));
        const std::size_t columns = record.columns.size();
        const std::uint16_t stream = add_stream(type_of(sensor), topic_of(sensor));
        for (std::size_t row = 0; row < record.numbers.size(); ++row) {
            const double time = static_cast<double>(record.numbers[row]) / sensor.update_rate;
            const RosHeader header{checked(stamps_.at(std::nullopt, time)), ros_word(sensor.name)};
            std::string data = message_of(sensor, header, &record.values[row * columns]);
            if (!data.empty()) add(stream, header.stamp, std::move(data));
        }
    }

    static RosType type_of(const NavigationSensorDesc& sensor) {
        struct Visitor {
            RosType operator()(const ImuDesc&) { return RosType::imu; }
            RosType operator()(const PressureDesc&) { return RosType::fluid_pressure; }
            RosType operator()(const DvlDesc&) { return RosType::twist; }
            RosType operator()(const AltimeterDesc&) { return RosType::point; }
            RosType operator()(const MagnetometerDesc&) { return RosType::magnetic_field; }
        };
        return std::visit(Visitor(), sensor.kind);
    }

    /// The message of a reading, whose values are in the order of SensorRecord::columns; empty for
    /// a sensor that has lost what it measures.
    static std::string message_of(const NavigationSensorDesc& sensor, const RosHeader& header,
                                  const double* v) {
        struct Visitor {
            const RosHeader& header;
            const double* v;
            double rate;

            /// Of one reading.
            RosVariances variances(const TriadDesc& triad) const {
                return RosVariances(triad.noise_density * triad.noise_density * rate);
            }
            std::string operator()(const ImuDesc& imu) const {
                return ros_imu(header, {v[0], v[1], v[2]}, variances(imu.gyroscope),
                               {v[3], v[4], v[5]}, variances(imu.accelerometer));
            }
            std::string operator()(const PressureDesc& pressure) const {
                return ros_fluid_pressure(header, v[0],
                                          pressure.error.noise * pressure.error.noise);
            }
            std::string operator()(const DvlDesc& dvl) const {
                if (v[3] == 0) return {};
                // The covariance of least squares with the beams that there are.
                const std::array<Vector3, 4> beams = beam_directions(dvl);
                Matrix3 squares(0.0);
                for (std::size_t beam = 0; beam < beams.size(); ++beam)
                    for (int column = 0; column < 3 && std::isfinite(v[4 + beam]); ++column)
                        squares[column] += beams[beam] * beams[beam][column];
                return ros_twist(header, {v[0], v[1], v[2]},
                                 glm::inverse(squares) * (dvl.velocity.noise * dvl.velocity.noise));
            }
            std::string operator()(const AltimeterDesc&) const {
                return std::isfinite(v[0]) ? ros_point(header, {0, 0, v[0]}) : std::string();
            }
            std::string operator()(const MagnetometerDesc& magnetometer) const {
                return ros_magnetic_field(header, {v[0], v[1], v[2]},
                                          variances(magnetometer.error));
            }
        };
        return std::visit(Visitor{header, v, sensor.update_rate}, sensor.kind);
    }

    const DatasetDefinition& definition_;
    const SceneDesc& whole_;
    FrameStamps stamps_;
    VehicleMotion vehicle_;
    RosReadings readings_;
};

std::string readings_file(const DatasetDefinition& definition, std::size_t draw) {
    return definition.folder(draw) + "views/readings.ros2";
}

void append_part(std::string& bytes, std::string_view text) {
    append_bytes(bytes, static_cast<std::uint32_t>(text.size()));
    bytes.append(text);
}

std::string readings_bytes(const RosReadings& readings) {
    std::string bytes;
    append_bytes(bytes, static_cast<std::uint32_t>(readings.mosaics.size()));
    for (const std::string& mosaic : readings.mosaics) append_part(bytes, mosaic);
    append_bytes(bytes, static_cast<std::uint32_t>(readings.streams.size()));
    for (const RosStream& stream : readings.streams) {
        append_bytes(bytes, static_cast<std::uint32_t>(stream.type));
        append_part(bytes, stream.topic);
    }
    append_bytes(bytes, static_cast<std::uint32_t>(readings.messages.size()));
    for (const RosReadings::Message& message : readings.messages) {
        append_bytes(bytes, message.stamp);
        append_bytes(bytes, message.stream);
        append_part(bytes, message.data);
    }
    return bytes;
}

/// Takes numbers and texts from the front of the program's own bytes.
class OwnBytes {
  public:
    OwnBytes(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

    template <class Number>
    Number take() {
        Number number{};
        const std::string_view part = take_bytes(sizeof(Number));
        std::memcpy(&number, part.data(), sizeof(Number));
        return number;
    }
    std::string_view take_text() { return take_bytes(take<std::uint32_t>()); }

  private:
    std::string_view take_bytes(std::size_t count) {
        if (count > bytes_.size())
            throw InputError(
                fmt::format("{}: is not what uwvdb wrote there; make the set again", name_));
        const std::string_view part = bytes_.substr(0, count);
        bytes_.remove_prefix(count);
        return part;
    }

    std::string_view bytes_;
    std::string name_;
};

RosReadings read_readings(const std::filesystem::path& file) {
    std::ifstream in = open_own_file(file);
    if (!in) throw IoError(fmt::format("{}: cannot be read", file.string()));
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    OwnBytes rest(bytes, file.string());
    RosReadings readings;
    for (auto count = rest.take<std::uint32_t>(); count > 0; --count)
        readings.mosaics.emplace_back(rest.take_text());
    for (auto count = rest.take<std::uint32_t>(); count > 0; --count) {
        const auto type = static_cast<RosType>(rest.take<std::uint32_t>());
        readings.streams.push_back({type, std::string(rest.take_text())});
    }
    for (auto count = rest.take<std::uint32_t>(); count > 0; --count) {
        RosReadings::Message message;
        message.stamp = rest.take<std::int64_t>();
        message.stream = rest.take<std::uint16_t>();
        message.data = rest.take_text();
        readings.messages.push_back(std::move(message));
    }
    return readings;
}

std::vector<NamedText> share_readings(const DatasetDefinition& definition, std::size_t draw,
                                      const SceneDesc& scene) {
    return {
        {readings_file(definition, draw), readings_bytes(ReadingsMaker(definition, scene).make())}};
}

/// An image as ROS has it: the numbers of the PNG, row by row, little-endian.
std::string image_message(const RosHeader& header, const std::filesystem::path& file,
                          const std::string& mosaic) {
    const PixelImage image = read_own_image(file);
    const auto png = read_png_header(file);
    if (!png || (image.channels != 1 && image.channels != 3))
        throw InputError(
            fmt::format("{}: is not what uwvdb wrote there; make the set again", file.string()));
    const bool is_wide = png->bits == 16;
    std::string rows;
    rows.reserve(image.pixels.size() * (is_wide ? 2 : 1));
    for (const float value : image.pixels) {
        if (is_wide)
            append_bytes(rows, static_cast<std::uint16_t>(std::lround(value * 65'535.0F)));
        else
            append_bytes(rows, static_cast<std::uint8_t>(std::lround(value * 255.0F)));
    }
    const std::string encoding = (image.channels == 3 ? std::string("rgb")
                                  : mosaic.empty()    ? std::string("mono")
                                                      : "bayer_" + mosaic) +
                                 (is_wide ? "16" : "8");
    return ros_image(header, image.width, image.height, encoding, rows);
}

/// The quality of service of a topic whose last message late subscribers get as well, in the words
/// of rosbag2.
constexpr const char* k_latched =
    "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n  deadline:\n    sec: "
    "9223372036\n    nsec: 854775807\n  lifespan:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  liveliness: 1\n  liveliness_lease_duration:\n    sec: 9223372036\n    nsec: 854775807\n"
    "  avoid_ros_namespace_conventions: false";

class Bag {
  public:
    Bag(const std::filesystem::path& file, const std::string& program)
        : writer_(file, "ros2", program) {}

    std::uint16_t add_stream(const RosStream& stream) {
        const std::string name(ros_name(stream.type));
        const auto [schema, is_new] = schemas_.try_emplace(name);
        if (is_new)
            schema->second = writer_.add_schema(name, "ros2msg", ros_definition(stream.type));
        const bool is_latched = stream.topic == "/tf_static";
        return writer_.add_channel(schema->second, stream.topic, "cdr",
                                   {{"offered_qos_profiles", is_latched ? k_latched : ""}});
    }
    void add(std::uint16_t channel, std::int64_t stamp, std::string_view data) {
        writer_.add_message(channel, static_cast<std::uint64_t>(stamp), data);
    }
    void commit() { writer_.commit(); }

  private:
    McapWriter writer_;
    std::map<std::string, std::uint16_t> schemas_;
};

void write_bag(const CompleteSequence& sequence, const std::filesystem::path& folder,
               const std::filesystem::path& file) {
    const DatasetDefinition& definition = sequence.definition;
    const RosReadings readings = read_readings(folder / readings_file(definition, sequence.draw));
    Bag bag(file, definition.program);
    std::vector<std::uint16_t> channels, infos, images;
    for (const RosStream& stream : readings.streams) channels.push_back(bag.add_stream(stream));
    for (std::size_t camera = 0; camera < definition.cameras.size(); ++camera) {
        const std::string topic = "/" + camera_frame(camera);
        infos.push_back(bag.add_stream({RosType::camera_info, topic + "/camera_info"}));
        images.push_back(bag.add_stream({RosType::image, topic + "/image_raw"}));
    }
    auto reading = readings.messages.begin();
    const auto add_readings_until = [&](std::int64_t stamp) {
        for (; reading != readings.messages.end() && reading->stamp <= stamp; ++reading)
            bag.add(channels.at(reading->stream), reading->stamp, reading->data);
    };
    for (std::size_t frame = 0; frame < definition.frames.size(); ++frame)
        for (std::size_t camera = 0; camera < definition.cameras.size(); ++camera) {
            throw_if_stopped();
            const ViewRecord& view = sequence.at(frame, camera);
            const RosHeader header{view.stamp, camera_frame(camera)};
            add_readings_until(view.stamp);
            bag.add(infos[camera], view.stamp, ros_camera_info(header, sequence.portless(camera)));
            bag.add(images[camera], view.stamp,
                    image_message(header, folder / view.file("image")->path,
                                  readings.mosaics.at(camera)));
        }
    add_readings_until(std::numeric_limits<std::int64_t>::max());
    bag.commit();
}

void complete_bag(const CompleteSequence& sequence, SetFiles& files) {
    files.add("mcap", sequence.folder + "bag.mcap", [&](const std::filesystem::path& file) {
        write_bag(sequence, files.folder(), file);
    });
}

/// Refuses sensors that would share a topic or a frame.
void check_bag(const DatasetDefinition& definition, const SceneDesc& scene) {
    std::set<std::string> topics{"/tf", "/tf_static", "/odometry"};
    std::set<std::string> frames{k_world_frame, k_body_frame};
    for (std::size_t camera = 0; camera < definition.cameras.size(); ++camera) {
        frames.insert(camera_frame(camera));
        for (const char* kind : {"/camera_info", "/image_raw"})
            topics.insert("/" + camera_frame(camera) + kind);
    }
    for (const NavigationSensorDesc& sensor : scene.navigation)
        if (!topics.insert(topic_of(sensor)).second || !frames.insert(ros_word(sensor.name)).second)
            throw UsageError(fmt::format(
                "--format mcap: the topic {} or the frame {} of {} is taken; give the sensor "
                "another name, or the IMU another rostopic",
                topic_of(sensor), ros_word(sensor.name), sensor.where));
}

}  // namespace

DatasetFormat mcap_format() {
    return {
        .name = "mcap",
        .summary = "bag.mcap: ROS 2 bag of images, cameras, sensors and true poses",
        .card =
            "`bag.mcap`: a ROS 2 bag (MCAP, messages of Humble to Jazzy). `/cam0/image_raw` and "
            "`/cam0/camera_info` and so on; IMUs at their `rostopic`, other sensors at their "
            "names: `FluidPressure`, `MagneticField`, a DVL as `TwistWithCovarianceStamped` "
            "(not while it has lost the bottom), an altimeter as `PointStamped` on its axis. "
            "`/odometry` and `/tf` are the true motion of the frame `body` (rig or camera, x "
            "right, y down, z forward) in `world` at each frame, `/tf_static` has cameras and "
            "sensors on it. Behind a port `camera_info` is that in air, or fitted (above). The "
            "truth of readings and a DVL's beams have no place here.",
        .needs_images = true,
        .ports = DatasetFormat::Ports::fitted,
        .check = check_bag,
        .share = share_readings,
        .complete = complete_bag};
}

}  // namespace uw
