#include "core/scene/navigation_sensor_desc.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/base/input_files.h"
#include "core/base/text.h"
#include "core/scene/trajectory_reader.h"
#include "core/scene/yaml_document.h"

namespace uw {

namespace {

constexpr double k_max_readings_per_second = 10'000;
constexpr int k_max_sensor_seed = 2'147'483'647;
constexpr std::size_t k_longest_imu_file = 1 << 20;  // bytes; Kalibr's have 300

/// The keys of a group that share a prefix: `accelerometer_bias`.
class PrefixedKeys {
  public:
    PrefixedKeys(ConfigMap& map, std::string prefix) : map_(map), prefix_(std::move(prefix)) {}

    std::optional<ConfigValue> find(std::string_view key) const {
        return map_.find(prefix_ + std::string(key));
    }

  private:
    ConfigMap& map_;
    std::string prefix_;
};

/// Replaces those of the errors whose keys are there.
void read_triad(const PrefixedKeys& keys, std::string_view unit, TriadDesc& triad) {
    const auto hint = [&](std::string_view what) { return fmt::format("give {} {}", what, unit); };
    if (const auto entry = keys.find("noise_density"))
        triad.noise_density =
            entry->non_negative(hint("the density of the white noise, per root "
                                     "of Hz, in"));
    if (const auto entry = keys.find("random_walk"))
        triad.random_walk =
            entry->non_negative(hint("the density of the bias's random walk, per second and root "
                                     "of Hz, in"));
    if (const auto entry = keys.find("scale")) {
        triad.scale = entry->vector("give three factors, of x, y and z; 1 is right");
        for (int axis = 0; axis < 3; ++axis)
            if (!(triad.scale[axis] > 0.5 && triad.scale[axis] < 2))
                entry->fail("is not close to 1; give the factors of x, y and z, such as 1.002");
    }
    if (const auto entry = keys.find("misalignment")) {
        triad.misalignment =
            entry->vector("give three numbers, how much of x reads as y, of x as z, of y as z");
        for (int i = 0; i < 3; ++i)
            if (!(std::abs(triad.misalignment[i]) < 0.5))
                entry->fail("is not small; give radians, such as [0.001, -0.002, 0.0005]");
    }
    if (const auto entry = keys.find("bias"))
        triad.bias = entry->vector(hint("the bias of x, y and z at the first reading, in"));
    if (const auto entry = keys.find("range"))
        triad.range = entry->positive(hint("the largest reading, in"));
    if (const auto entry = keys.find("bits")) {
        triad.bits = entry->integer(4, 32, "give the bits of a reading, 4 to 32");
        if (!triad.range) entry->fail("spans a range; give that, too");
    }
}

/// What a Kalibr file says of an IMU.
struct KalibrImu {
    TriadDesc accelerometer, gyroscope;
    double update_rate = 0;
    std::string rostopic;
};

/// Kalibr's imu.yaml, or the result of its calibration, in which the same stands under `imu0`.
KalibrImu read_kalibr_imu(const ConfigValue& value, const SceneContext& context) {
    constexpr auto k_noise = "give the density, as Kalibr's imu.yaml has it";
    const std::filesystem::path file = read_existing_file(value, context);
    const std::string subject =
        fmt::format("{}: '{}'", value.location(), printable(file.string(), 300));
    const std::string text = read_text_file(file, subject, k_longest_imu_file, "IMU file");
    const ConfigNode root = parse_yaml(text, file.string(), {.subject = "IMU file"});
    const ConfigNode* imu = root.find("imu0");
    ConfigMap map(
        imu != nullptr ? ConfigValue(*imu, "imu0") : ConfigValue(root, ""),
        {"accelerometer_noise_density", "accelerometer_random_walk", "gyroscope_noise_density",
         "gyroscope_random_walk", "update_rate", "rostopic", "model", "time_offset", "T_i_b"},
        "write it as Kalibr's imu.yaml");
    KalibrImu result;
    const auto number = [&](const char* key) {
        return map.require(key, k_noise).non_negative(k_noise);
    };
    result.accelerometer.noise_density = number("accelerometer_noise_density");
    result.accelerometer.random_walk = number("accelerometer_random_walk");
    result.gyroscope.noise_density = number("gyroscope_noise_density");
    result.gyroscope.random_walk = number("gyroscope_random_walk");
    constexpr auto k_rate = "give the readings per second";
    result.update_rate = map.require("update_rate", k_rate).positive(k_rate);
    if (const auto topic = map.find("rostopic")) result.rostopic = topic->text("name the topic");
    if (const auto model = map.find("model"))
        if (model->text("give calibrated") != "calibrated")
            model->fail(
                "only 'calibrated' is read from a file; give scale and misalignment in the scene");
    if (const auto offset = map.find("time_offset"))
        if (offset->number("give 0") != 0)
            offset->fail("the IMU has the scene's clock; write 0, or leave it out");
    map.find("T_i_b");  // where the scene's pose has the sensor is what counts
    return result;
}

NavigationSensorDesc::Kind read_imu(ConfigMap& map, const SceneContext& context,
                                    NavigationSensorDesc& sensor) {
    ImuDesc imu;
    if (const auto file = map.find("file")) {
        const KalibrImu given = read_kalibr_imu(*file, context);
        imu.accelerometer = given.accelerometer;
        imu.gyroscope = given.gyroscope;
        if (!given.rostopic.empty()) imu.rostopic = given.rostopic;
        if (given.update_rate > k_max_readings_per_second)
            file->fail("its update_rate is above 10000 Hz; give another");
        sensor.update_rate = given.update_rate;
    }
    read_triad({map, "accelerometer_"}, "m/s^2", imu.accelerometer);
    read_triad({map, "gyroscope_"}, "rad/s", imu.gyroscope);
    if (const auto gravity = map.find("gravity"))
        imu.gravity = gravity->within(0, 100, "give the acceleration of gravity in m/s^2");
    if (const auto up = map.find("up")) sensor.up = up->direction("give the direction that is up");
    if (const auto topic = map.find("rostopic"))
        imu.rostopic = topic->text("name the topic, such as /imu0");
    return imu;
}

/// The keys `prefix`noise, bias and resolution.
ScalarErrorDesc read_scalar_error(const PrefixedKeys& keys, std::string_view unit) {
    ScalarErrorDesc error;
    const auto hint = [&](std::string_view what) { return fmt::format("give {} {}", what, unit); };
    if (const auto entry = keys.find("noise"))
        error.noise = entry->non_negative(hint("the standard deviation of a reading in"));
    if (const auto entry = keys.find("bias")) error.bias = entry->number(hint("the bias in"));
    if (const auto entry = keys.find("resolution"))
        error.resolution = entry->non_negative(hint("the step of readings in"));
    return error;
}

PressureDesc::Tide read_tide(const ConfigValue& value) {
    constexpr auto k_tide_example = "write {amplitude: 1.5, period: 44714, phase: 0}";
    ConfigMap map(value, {"amplitude", "period", "phase"}, k_tide_example);
    PressureDesc::Tide tide;
    tide.amplitude = map.require("amplitude", k_tide_example).non_negative("give metres");
    tide.period = map.require("period", k_tide_example)
                      .positive(
                          "give seconds; the tide of the moon "
                          "has 44714");
    if (const auto phase = map.find("phase"))
        tide.phase = phase->within(-1, 1,
                                   "give the phase at the scene's time 0 as a fraction of "
                                   "the period, -1 to 1");
    return tide;
}

NavigationSensorDesc::Kind read_pressure(ConfigMap& map, const SceneContext& context) {
    PressureDesc pressure;
    if (!context.water_surface)
        map.value().fail(
            "measures how deep it is below the water's surface, which is missing; add "
            "water.surface: {height: 12}");
    pressure.error = read_scalar_error({map, ""}, "Pa");
    if (const auto air = map.find("atmospheric_pressure"))
        pressure.atmospheric_pressure =
            air->within(0, 200'000, "give the air's pressure at the water's surface in Pa");
    if (const auto gravity = map.find("gravity"))
        pressure.gravity = gravity->within(0, 100, "give the acceleration of gravity in m/s^2");
    if (const auto tide = map.find("tide")) pressure.tide = read_tide(*tide);
    return pressure;
}

EchoRangeDesc read_reach(ConfigMap& map, EchoRangeDesc reach) {
    if (const auto entry = map.find("min_range"))
        reach.nearest = entry->non_negative("give the least distance measured in metres");
    const auto farthest = map.find("max_range");
    if (farthest) reach.farthest = farthest->positive("give the greatest distance in metres");
    if (!(reach.farthest > reach.nearest))
        (farthest ? *farthest : *map.find("min_range"))
            .fail("leaves no distance between min_range and max_range; give max_range > min_range");
    if (const auto entry = map.find("max_incidence"))
        reach.steepest = entry->within(0, 90,
                                       "give the angle, in degrees between a beam and the "
                                       "surface's normal, beyond which no echo returns");
    return reach;
}

NavigationSensorDesc::Kind read_dvl(ConfigMap& map) {
    DvlDesc dvl;
    if (const auto entry = map.find("beam_angle"))
        dvl.beam_angle =
            entry->between(0, 90, "give the angle between the beams and their axis in degrees");
    if (const auto entry = map.find("azimuth"))
        dvl.azimuth = entry->within(-360, 360,
                                    "give the direction of the first beam around the "
                                    "axis, in degrees from x towards y");
    dvl.velocity = read_scalar_error({map, "velocity_"}, "m/s");
    dvl.range = read_scalar_error({map, "range_"}, "m");
    if (const auto entry = map.find("dropout"))
        dvl.dropout = entry->within(0, 1, "give the probability that a beam is lost, 0 to 1");
    dvl.reach = read_reach(map, dvl.reach);
    return dvl;
}

NavigationSensorDesc::Kind read_altimeter(ConfigMap& map) {
    AltimeterDesc altimeter;
    if (const auto entry = map.find("beam"))
        altimeter.beam = entry->within(0, 90, "give the full angle of the beam in degrees");
    altimeter.error = read_scalar_error({map, ""}, "m");
    altimeter.reach = read_reach(map, altimeter.reach);
    return altimeter;
}

NavigationSensorDesc::Kind read_magnetometer(ConfigMap& map) {
    constexpr auto k_hint =
        "give the Earth's field in the world's axes in tesla, such as [0, -44e-6, -18e-6]";
    MagnetometerDesc magnetometer;
    const ConfigValue field = map.require("field", k_hint);
    magnetometer.field = field.vector(k_hint);
    if (!(glm::length(magnetometer.field) < 1e-3))
        field.fail(fmt::format("is stronger than any field of the Earth's, 65e-6; {}", k_hint));
    read_triad({map, ""}, "T", magnetometer.error);
    return magnetometer;
}

/// `frame` and `pose`. `looks_down`: of a sensor whose z axis points down without a pose.
Affine read_mount(ConfigMap& map, const SceneContext& context, bool looks_down) {
    enum class Frame { camera, rig };
    constexpr std::array<std::pair<std::string_view, Frame>, 2> k_frames{
        {{"camera", Frame::camera}, {"rig", Frame::rig}}};
    Frame frame = context.rig ? Frame::rig : Frame::camera;
    if (const auto entry = map.find("frame")) {
        frame = entry->choice(k_frames);
        if (frame == Frame::rig && !context.rig)
            entry->fail(
                "there is no rig in this scene; use camera, or give cameras: a list of named "
                "cameras");
    }
    Affine frame_from_sensor;
    // Down in the frame is y, and the sensor's x is the frame's.
    if (looks_down) frame_from_sensor = Affine::rotation_xyz_degrees({-90, 0, 0});
    if (const auto pose = map.find("pose")) frame_from_sensor = read_placed_pose(*pose);
    if (!context.rig) return frame_from_sensor;
    return (frame == Frame::rig ? context.rig->world_from_rig : context.rig->world_from_camera) *
           frame_from_sensor;
}

enum class SensorType { light, imu, pressure, dvl, altimeter, magnetometer };

constexpr std::array<std::pair<std::string_view, SensorType>, 6> k_types{
    {{"light", SensorType::light},
     {"imu", SensorType::imu},
     {"pressure", SensorType::pressure},
     {"dvl", SensorType::dvl},
     {"altimeter", SensorType::altimeter},
     {"magnetometer", SensorType::magnetometer}}};

/// The keys of all types, each of which uses some.
constexpr std::array k_sensor_keys = std::to_array<std::string_view>({"type",
                                                                      "name",
                                                                      "position",
                                                                      "from",
                                                                      "to",
                                                                      "count",
                                                                      "up",
                                                                      "frame",
                                                                      "pose",
                                                                      "update_rate",
                                                                      "seed",
                                                                      "file",
                                                                      "accelerometer_noise_density",
                                                                      "accelerometer_random_walk",
                                                                      "accelerometer_scale",
                                                                      "accelerometer_misalignment",
                                                                      "accelerometer_bias",
                                                                      "accelerometer_range",
                                                                      "accelerometer_bits",
                                                                      "gyroscope_noise_density",
                                                                      "gyroscope_random_walk",
                                                                      "gyroscope_scale",
                                                                      "gyroscope_misalignment",
                                                                      "gyroscope_bias",
                                                                      "gyroscope_range",
                                                                      "gyroscope_bits",
                                                                      "gravity",
                                                                      "rostopic",
                                                                      "noise",
                                                                      "bias",
                                                                      "resolution",
                                                                      "atmospheric_pressure",
                                                                      "tide",
                                                                      "beam_angle",
                                                                      "azimuth",
                                                                      "velocity_noise",
                                                                      "velocity_bias",
                                                                      "velocity_resolution",
                                                                      "range_noise",
                                                                      "range_bias",
                                                                      "range_resolution",
                                                                      "dropout",
                                                                      "min_range",
                                                                      "max_range",
                                                                      "max_incidence",
                                                                      "beam",
                                                                      "field",
                                                                      "noise_density",
                                                                      "random_walk",
                                                                      "scale",
                                                                      "misalignment",
                                                                      "range",
                                                                      "bits"});

constexpr double default_rate(SensorType type) {
    switch (type) {
        case SensorType::imu:
            return 200;
        case SensorType::magnetometer:
            return 50;
        case SensorType::dvl:
            return 5;
        default:
            return 10;
    }
}

NavigationSensorDesc read_navigation_sensor(ConfigMap& map, SensorType type, std::size_t number,
                                            const SceneContext& context) {
    NavigationSensorDesc sensor;
    sensor.where = map.value().location();
    sensor.name = fmt::format("sensor{}", number);
    if (const auto name = map.find("name"))
        sensor.name = read_short_name(*name, "a file's name", "write name: imu");
    sensor.update_rate = default_rate(type);
    const bool looks_down = type == SensorType::dvl || type == SensorType::altimeter;
    sensor.body_from_sensor = read_mount(map, context, looks_down);
    if (context.water_surface) sensor.up = context.water_surface->normal;
    switch (type) {
        case SensorType::imu:
            sensor.kind = read_imu(map, context, sensor);
            break;
        case SensorType::pressure:
            sensor.kind = read_pressure(map, context);
            break;
        case SensorType::dvl:
            sensor.kind = read_dvl(map);
            break;
        case SensorType::altimeter:
            sensor.kind = read_altimeter(map);
            break;
        case SensorType::magnetometer:
        case SensorType::light:
            sensor.kind = read_magnetometer(map);
            break;
    }
    if (const auto rate = map.find("update_rate"))
        sensor.update_rate = rate->within(1e-3, k_max_readings_per_second,
                                          "give the readings per second, 0.001 to 10000");
    if (const auto seed = map.find("seed"))
        sensor.seed = static_cast<std::uint64_t>(
            seed->integer(0, k_max_sensor_seed, "give a whole number, 0 to 2147483647"));
    map.finish(fmt::format("type '{}'", type_word(sensor)));
    return sensor;
}

}  // namespace

const char* type_word(const NavigationSensorDesc& sensor) {
    constexpr std::array k_words{"imu", "pressure", "dvl", "altimeter", "magnetometer"};
    return k_words.at(sensor.kind.index());
}

void read_sensors(const ConfigValue& value, const SceneContext& context,
                  std::vector<MeterDesc>& meters, std::vector<NavigationSensorDesc>& navigation) {
    for (const ConfigValue& entry : value.list("write one '- name: ...' per sensor")) {
        const std::size_t number = meters.size() + navigation.size() + 1;
        ConfigMap map(entry, {k_sensor_keys.begin(), k_sensor_keys.end()},
                      "write {type: imu, update_rate: 200}");
        const auto word = map.find("type");
        const SensorType type = word ? word->choice(k_types) : SensorType::light;
        std::optional<MeterDesc> meter;
        std::optional<NavigationSensorDesc> sensor;
        if (type == SensorType::light)
            meter = read_meter(entry, number, context);
        else
            sensor = read_navigation_sensor(map, type, number, context);
        const std::string& name = meter ? meter->name : sensor->name;
        if (std::ranges::find(meters, name, &MeterDesc::name) != meters.end() ||
            std::ranges::find(navigation, name, &NavigationSensorDesc::name) != navigation.end())
            entry.fail(
                fmt::format("the name '{}' is taken by another sensor; give each its own", name));
        if (meter) meters.push_back(std::move(*meter));
        if (sensor) navigation.push_back(std::move(*sensor));
    }
}

}  // namespace uw
