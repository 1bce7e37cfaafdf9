// ctest labels: unit analytic
// The ROS 2 bag of a data set, read by the specification: every record, index and checksum of MCAP,
// and messages as CDR has them. @mcap/core and rosmsg2-serialization read the same.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/json.h"
#include "core/base/text.h"
#include "core/image/image_file.h"
#include "dataset/mcap_writer.h"
#include "tests/support/dataset/dataset_scenes.h"

namespace uw {
namespace {

/// The checksum bit by bit, as ISO 3309 defines it.
std::uint32_t checksum(std::string_view bytes) {
    std::uint32_t crc = 0xffffffffU;
    for (const char c : bytes) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) ? (crc >> 1U) ^ 0xedb88320U : crc >> 1U;
    }
    return ~crc;
}

/// Reads little-endian values from the front of bytes.
class Front {
  public:
    explicit Front(std::string_view bytes) : bytes_(bytes), all_(bytes.size()) {}

    template <class Number>
    Number number() {
        Number value{};
        std::memcpy(&value, take(sizeof(Number)).data(), sizeof(Number));
        return value;
    }
    std::string_view text() { return take(number<std::uint32_t>()); }
    std::string_view long_text() { return take(number<std::uint64_t>()); }
    std::string_view rest() { return take(bytes_.size()); }
    bool empty() const { return bytes_.empty(); }
    std::size_t place() const { return all_ - bytes_.size(); }

    // CDR: aligned to their own size after four bytes that say how they are written.
    template <class Number>
    Number aligned() {
        while ((place() - 4) % sizeof(Number) != 0) take(1);
        return number<Number>();
    }
    std::string aligned_text() {
        const auto length = aligned<std::uint32_t>();
        std::string text(take(length));
        EXPECT_EQ(text.back(), '\0');
        text.pop_back();
        return text;
    }
    template <std::size_t N>
    std::array<double, N> doubles() {
        std::array<double, N> values{};
        for (double& value : values) value = aligned<double>();
        return values;
    }
    /// A header's stamp, and its frame.
    std::pair<std::int64_t, std::string> header() {
        const auto seconds = aligned<std::int32_t>();
        const auto rest = aligned<std::uint32_t>();
        return {std::int64_t{1'000'000'000} * seconds + rest, aligned_text()};
    }

  private:
    std::string_view take(std::size_t count) {
        if (count > bytes_.size()) throw std::runtime_error("the bytes end early");
        const std::string_view part = bytes_.substr(0, count);
        bytes_.remove_prefix(count);
        return part;
    }

    std::string_view bytes_;
    std::size_t all_;
};

struct Record {
    int kind = 0;
    std::size_t begin = 0, end = 0;  // in the file
    std::string_view content;
};

std::vector<Record> records_of(std::string_view bytes, std::size_t begin) {
    std::vector<Record> records;
    for (Front front(bytes); !front.empty();) {
        Record record;
        record.begin = begin + front.place();
        record.kind = front.number<std::uint8_t>();
        record.content = front.long_text();
        record.end = begin + front.place();
        records.push_back(record);
    }
    return records;
}

struct BagMessage {
    std::uint64_t time = 0;
    std::string data;
};

/// A bag, all of whose structure has been checked.
struct CheckedBag {
    std::string profile;
    std::map<std::string, std::string> types, definitions, qos;  // by topic
    std::map<std::string, std::vector<BagMessage>> messages;     // likewise
    std::size_t chunks = 0;
};

CheckedBag checked_bag(const std::string& file) {
    CheckedBag bag;
    const std::string magic("\x89MCAP0\r\n", 8);
    EXPECT_EQ(file.substr(0, 8), magic);
    EXPECT_EQ(file.substr(file.size() - 8), magic);
    const auto records = records_of(std::string_view(file).substr(8, file.size() - 16), 8);
    std::map<std::uint16_t, std::pair<std::string, std::string>> schemas;  // name, text
    std::map<std::uint16_t, std::string> topics;
    std::map<std::uint16_t, std::uint64_t> counts;
    std::map<std::size_t, std::pair<std::uint64_t, std::uint64_t>> chunks;  // times by place
    std::string_view chunk;                                                 // whose indices follow
    std::size_t summary = 0, indexed = 0, chunk_indices = 0;
    std::uint64_t total = 0, last_time = 0;
    for (const Record& record : records) {
        Front front(record.content);
        const bool is_summary = summary > 0;
        switch (record.kind) {
            case 1:
                bag.profile = front.text();
                EXPECT_NE(front.text().find("uwvdb"), std::string_view::npos);
                break;
            case 3: {
                const auto id = front.number<std::uint16_t>();
                const std::string name(front.text());
                EXPECT_EQ(front.text(), "ros2msg");
                const std::pair schema{name, std::string(front.text())};
                if (is_summary) {
                    EXPECT_EQ(schemas.at(id), schema);
                }
                schemas[id] = schema;
                break;
            }
            case 4: {
                const auto id = front.number<std::uint16_t>();
                const auto& [type, definition] = schemas.at(front.number<std::uint16_t>());
                const std::string topic(front.text());
                EXPECT_EQ(front.text(), "cdr");
                Front metadata(front.text());
                EXPECT_EQ(metadata.text(), "offered_qos_profiles");
                bag.qos[topic] = metadata.text();
                EXPECT_EQ(bag.types.contains(topic), is_summary);
                bag.types[topic] = type;
                bag.definitions[topic] = definition;
                topics[id] = topic;
                break;
            }
            case 6: {
                const auto first = front.number<std::uint64_t>(),
                           last = front.number<std::uint64_t>();
                const auto size = front.number<std::uint64_t>();
                const auto crc = front.number<std::uint32_t>();
                EXPECT_EQ(front.text(), "");
                chunk = front.long_text();
                EXPECT_EQ(chunk.size(), size);
                EXPECT_EQ(checksum(chunk), crc);
                chunks[record.begin] = {first, last};
                for (const Record& inner : records_of(chunk, 0)) {
                    EXPECT_EQ(inner.kind, 5);
                    Front message(inner.content);
                    const auto channel = message.number<std::uint16_t>();
                    EXPECT_EQ(message.number<std::uint32_t>(), counts[channel]++);
                    const auto time = message.number<std::uint64_t>();
                    EXPECT_EQ(message.number<std::uint64_t>(), time);
                    EXPECT_TRUE(first <= time && time <= last);
                    EXPECT_GE(time, last_time);
                    last_time = time;
                    bag.messages[topics.at(channel)].push_back({time, std::string(message.rest())});
                    ++total;
                }
                break;
            }
            case 7: {
                const auto channel = front.number<std::uint16_t>();
                for (Front entries(front.text()); !entries.empty(); ++indexed) {
                    const auto time = entries.number<std::uint64_t>();
                    Front at(chunk.substr(entries.number<std::uint64_t>()));
                    EXPECT_EQ(at.number<std::uint8_t>(), 5);
                    at.number<std::uint64_t>();
                    EXPECT_EQ(at.number<std::uint16_t>(), channel);
                    at.number<std::uint32_t>();
                    EXPECT_EQ(at.number<std::uint64_t>(), time);
                }
                break;
            }
            case 8: {
                const std::pair times{front.number<std::uint64_t>(), front.number<std::uint64_t>()};
                const auto begin = front.number<std::uint64_t>(),
                           length = front.number<std::uint64_t>();
                EXPECT_EQ(chunks.at(begin), times);
                const auto next = std::ranges::find(records, begin + length, &Record::begin);
                EXPECT_NE(next, records.end());
                std::size_t end = begin + length;
                for (Front entries(front.text()); !entries.empty();) {
                    const auto channel = entries.number<std::uint16_t>();
                    const auto index =
                        std::ranges::find(records, entries.number<std::uint64_t>(), &Record::begin);
                    EXPECT_EQ(index->kind, 7);
                    EXPECT_EQ(Front(index->content).number<std::uint16_t>(), channel);
                    end = std::max(end, index->end);
                }
                EXPECT_EQ(front.number<std::uint64_t>(), end - begin - length);
                ++chunk_indices;
                break;
            }
            case 11: {
                EXPECT_EQ(front.number<std::uint64_t>(), total);
                EXPECT_EQ(front.number<std::uint16_t>(), schemas.size());
                EXPECT_EQ(front.number<std::uint32_t>(), topics.size());
                EXPECT_EQ(front.number<std::uint64_t>(), 0U);  // attachments and metadata
                EXPECT_EQ(front.number<std::uint32_t>(), chunks.size());
                EXPECT_EQ(front.number<std::uint64_t>(), chunks.begin()->second.first);
                EXPECT_EQ(front.number<std::uint64_t>(), last_time);
                Front entries(front.text());
                for (const auto& [channel, topic] : topics) {
                    EXPECT_EQ(entries.number<std::uint16_t>(), channel);
                    EXPECT_EQ(entries.number<std::uint64_t>(), counts[channel]);
                }
                EXPECT_TRUE(entries.empty());
                break;
            }
            case 14: {
                const int kind = front.number<std::uint8_t>();
                const auto begin = front.number<std::uint64_t>(),
                           length = front.number<std::uint64_t>();
                for (const Record& member : records)
                    if (member.begin >= begin && member.begin < begin + length) {
                        EXPECT_EQ(member.kind, kind);
                    }
                break;
            }
            case 15:
                EXPECT_EQ(front.number<std::uint32_t>(), checksum(file.substr(0, record.begin)));
                summary = record.end;
                break;
            case 2: {
                EXPECT_EQ(front.number<std::uint64_t>(), summary);
                const auto offsets = front.number<std::uint64_t>();
                EXPECT_EQ(std::ranges::find(records, 14, &Record::kind)->begin, offsets);
                EXPECT_EQ(front.number<std::uint32_t>(),
                          checksum(file.substr(summary, record.end - 4 - summary)));
                EXPECT_EQ(record.end, file.size() - 8);
                break;
            }
            default:
                ADD_FAILURE() << "record of kind " << record.kind;
        }
    }
    EXPECT_EQ(indexed, total);
    EXPECT_EQ(chunk_indices, chunks.size());
    bag.chunks = chunks.size();
    return bag;
}

const std::string k_vehicle = R"(uwvdb: 1
rig:
  trajectory:
    keyframes:
      - {time: 0, position: [0, 0, 0], look_at: [0, 0, 4], up: [0, -1, 0]}
      - {time: 0.5, position: [0.2, 0.1, 0.1], look_at: [0.1, 0, 4], up: [0.1, -1, 0]}
      - {time: 1, position: [0.5, 0.1, 0.2], look_at: [0.3, 0, 4], up: [0, -1, 0]}
cameras:
  - {name: left, resolution: [9, 6], intrinsics: {fx: 7, fy: 6, cx: 4, cy: 3},
     distortion: {k: [-0.1, 0.02, 0.003], p: [0.001, 0.002]}}
  - {name: right, resolution: [8, 6], intrinsics: {fx: 7, fy: 7, cx: 4, cy: 3},
     distortion: {model: fisheye, k1: 0.01}, pose: {position: [0.1, 0, 0], rotate: [0, -3, 1]}}
sensors:
  - {type: imu, name: front, update_rate: 100, pose: {position: [0, 0, -0.3], rotate: [90, 0, 0]},
     accelerometer_noise_density: 0.002, gyroscope_noise_density: 0.0002}
  - {type: dvl, name: bottom-lock, update_rate: 10, velocity_noise: 0.01, pose: {rotate: [0, 0, 0]}}
  - {type: altimeter, name: sonar, update_rate: 10, pose: {rotate: [0, 0, 0]}}
  - {type: altimeter, name: deaf, update_rate: 10, pose: {rotate: [0, 180, 0]}}
  - {type: pressure, name: depth, update_rate: 5, noise: 20}
  - {type: magnetometer, name: compass, update_rate: 5, field: [0, -44e-6, -18e-6]}
)" + [] {
    std::string world = test::small_world();
    return world.insert(world.find('\n') + 1, "  surface: {height: 10}\n");
}() + R"(lamps:
  - {name: left, position: [-0.5, -0.2, 0], intensity: [50, 40, 30]}
render: {fps: 2, samples: 1}
)";

class RosBag : public test::DatasetTest {
  protected:
    RosBag() { write("vehicle.yaml", k_vehicle); }

    /// The columns of a sensor's CSV by row.
    std::vector<std::vector<double>> readings(const std::string& name) const {
        std::vector<std::vector<double>> rows;
        const std::string text = read("set/sensors/" + name + ".csv");
        for (const std::string_view line : split(text, '\n')) {
            if (line.empty() || line.front() == '#' || line.starts_with("stamp_ns")) continue;
            std::vector<double>& row = rows.emplace_back();
            for (const std::string_view cell : split(line, ',')) {
                double value = std::nan("");
                if (!cell.empty()) parse_number(cell, value);
                row.push_back(value);
            }
        }
        return rows;
    }
};

TEST(McapChecksum, IsThatOfTheStandard) {
    EXPECT_EQ(crc32_of("123456789"), 0xcbf43926U);  // the check value of ISO 3309's CRC-32
    EXPECT_EQ(crc32_of("456789", crc32_of("123")), 0xcbf43926U);
}

TEST_F(RosBag, HasEveryMessageAsTheOtherFormatsHaveIt) {
    make("vehicle.yaml", "mcap,sensors", {"--exposure", "1"});
    const CheckedBag bag = checked_bag(read("set/bag.mcap"));
    EXPECT_EQ(bag.profile, "ros2");
    EXPECT_EQ(bag.types, (std::map<std::string, std::string>{
                             {"/tf_static", "tf2_msgs/msg/TFMessage"},
                             {"/tf", "tf2_msgs/msg/TFMessage"},
                             {"/odometry", "nav_msgs/msg/Odometry"},
                             {"/imu0", "sensor_msgs/msg/Imu"},
                             {"/bottom_lock", "geometry_msgs/msg/TwistWithCovarianceStamped"},
                             {"/sonar", "geometry_msgs/msg/PointStamped"},
                             {"/deaf", "geometry_msgs/msg/PointStamped"},
                             {"/depth", "sensor_msgs/msg/FluidPressure"},
                             {"/compass", "sensor_msgs/msg/MagneticField"},
                             {"/cam0/camera_info", "sensor_msgs/msg/CameraInfo"},
                             {"/cam0/image_raw", "sensor_msgs/msg/Image"},
                             {"/cam1/camera_info", "sensor_msgs/msg/CameraInfo"},
                             {"/cam1/image_raw", "sensor_msgs/msg/Image"}}));
    EXPECT_NE(bag.definitions.at("/imu0").find("\nMSG: builtin_interfaces/Time\nint32 sec\n"),
              std::string::npos);
    EXPECT_NE(bag.qos.at("/tf_static").find("durability: 1"), std::string::npos);
    EXPECT_FALSE(bag.messages.contains("/deaf"));  // no surface is behind it

    const auto imu = readings("front");
    const auto& imu_messages = bag.messages.at("/imu0");
    ASSERT_EQ(imu_messages.size(), 101U);
    for (std::size_t i = 0; i < imu.size(); ++i) {
        Front cdr(imu_messages[i].data);
        EXPECT_EQ(cdr.number<std::uint32_t>(), 0x100U);  // little-endian
        const auto [stamp, frame] = cdr.header();
        EXPECT_EQ(stamp, 10'000'000 * static_cast<std::int64_t>(i));
        EXPECT_EQ(imu_messages[i].time, static_cast<std::uint64_t>(stamp));
        EXPECT_EQ(frame, "front");
        EXPECT_EQ(cdr.doubles<4>(), (std::array<double, 4>{0, 0, 0, 1}));
        EXPECT_EQ(cdr.doubles<9>()[0], -1);
        EXPECT_EQ(cdr.doubles<3>(), (std::array{imu[i][2], imu[i][3], imu[i][4]}));
        EXPECT_NEAR(cdr.doubles<9>()[4], 0.0002 * 0.0002 * 100, 1e-18);
        EXPECT_EQ(cdr.doubles<3>(), (std::array{imu[i][5], imu[i][6], imu[i][7]}));
        EXPECT_NEAR(cdr.doubles<9>()[8], 0.002 * 0.002 * 100, 1e-16);
        EXPECT_TRUE(cdr.empty());
    }
    const auto dvl = readings("bottom-lock");
    for (std::size_t i = 0; i < dvl.size(); ++i) {
        Front cdr(bag.messages.at("/bottom_lock").at(i).data);
        cdr.number<std::uint32_t>();
        EXPECT_EQ(cdr.header().second, "bottom_lock");
        EXPECT_EQ(cdr.doubles<3>(), (std::array{dvl[i][2], dvl[i][3], dvl[i][4]}));
        EXPECT_EQ(cdr.doubles<3>(), (std::array<double, 3>{}));
        const auto covariance = cdr.doubles<36>();
        // Of four beams at 30 degrees: s^2 / (2 sin^2) across, s^2 / (4 cos^2) along the axis.
        EXPECT_NEAR(covariance[0], 1e-4 / (2 * 0.25), 1e-12);
        EXPECT_NEAR(covariance[14], 1e-4 / (4 * 0.75), 1e-12);
        EXPECT_EQ(covariance[35], -1);
        EXPECT_TRUE(cdr.empty());
    }
    Front point(bag.messages.at("/sonar").at(3).data);
    point.number<std::uint32_t>();
    point.header();
    EXPECT_EQ(point.doubles<3>(), (std::array{0.0, 0.0, readings("sonar")[3][2]}));
    Front pressure(bag.messages.at("/depth").at(2).data);
    pressure.number<std::uint32_t>();
    EXPECT_EQ(pressure.header().first, 400'000'000);
    EXPECT_EQ(pressure.doubles<2>(), (std::array{readings("depth")[2][2], 400.0}));
    Front magnetic(bag.messages.at("/compass").at(2).data);
    magnetic.number<std::uint32_t>();
    magnetic.header();
    EXPECT_EQ(magnetic.doubles<3>()[1], readings("compass")[2][3]);
}

TEST_F(RosBag, HasImagesCamerasAndPosesOfTheManifest) {
    make("vehicle.yaml", "mcap", {"--exposure", "1"});
    const CheckedBag bag = checked_bag(read("set/bag.mcap"));
    Front fixed(bag.messages.at("/tf_static").at(0).data);
    fixed.number<std::uint32_t>();
    std::map<std::string, Affine> body_from;
    for (auto count = fixed.aligned<std::uint32_t>(); count > 0; --count) {
        EXPECT_EQ(fixed.header().second, "body");
        const std::string child = fixed.aligned_text();
        const auto t = fixed.doubles<3>();
        const auto q = fixed.doubles<4>();
        body_from[child] = Affine(Rotation{q[3], q[0], q[1], q[2]}.matrix(), {t[0], t[1], t[2]});
    }
    EXPECT_EQ(body_from.size(), 8U);
    EXPECT_EQ(body_from.at("front").offset(), Vector3(0, 0, -0.3));
    const Json manifest = Json::parse(read("set/manifest.json"));
    for (const Json& view : manifest.at("views")) {
        const auto frame = view.at("frame").get<std::size_t>();
        const bool is_left = view.at("camera") == "left";
        const std::string camera = is_left ? "cam0" : "cam1";
        // The body in the world, and the camera on it, are the camera in the world.
        Front moving(bag.messages.at("/tf").at(frame).data);
        moving.number<std::uint32_t>();
        EXPECT_EQ(moving.aligned<std::uint32_t>(), 1U);
        const auto [stamp, world] = moving.header();
        EXPECT_EQ(stamp, view.at("stamp_ns").get<std::int64_t>());
        EXPECT_EQ(world, "world");
        EXPECT_EQ(moving.aligned_text(), "body");
        const auto t = moving.doubles<3>();
        const auto q = moving.doubles<4>();
        const Affine seen = Affine(Rotation{q[3], q[0], q[1], q[2]}.matrix(), {t[0], t[1], t[2]}) *
                            body_from.at(camera);
        const auto p = view.at("position").get<std::array<double, 3>>();
        EXPECT_LT(glm::length(seen.offset() - Vector3(p[0], p[1], p[2])), 1e-12);
        Front odometry(bag.messages.at("/odometry").at(frame).data);
        odometry.number<std::uint32_t>();
        EXPECT_EQ(odometry.header().first, stamp);
        EXPECT_EQ(odometry.aligned_text(), "body");
        EXPECT_EQ(odometry.doubles<3>(), t);
        // Normalised once more, which may round the last digit.
        const auto turned = odometry.doubles<4>();
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(turned[i], q[i], 1e-15);
        odometry.doubles<36>();
        EXPECT_GT(odometry.doubles<3>()[0], 0.1);  // it swims to its right
        // The image is that of the PNG.
        Front image(bag.messages.at("/" + camera + "/image_raw").at(frame).data);
        image.number<std::uint32_t>();
        EXPECT_EQ(image.header(), (std::pair{stamp, camera}));
        EXPECT_EQ(image.aligned<std::uint32_t>(), 6U);
        const std::uint32_t width = is_left ? 9 : 8;
        EXPECT_EQ(image.aligned<std::uint32_t>(), width);
        EXPECT_EQ(image.aligned_text(), "rgb8");
        EXPECT_EQ(image.aligned<std::uint8_t>(), 0);
        EXPECT_EQ(image.aligned<std::uint32_t>(), 3 * width);
        const auto size = image.aligned<std::uint32_t>();
        const std::string_view rows = image.rest();
        ASSERT_EQ(rows.size(), size);
        const PixelImage png =
            read_image(folder_ / ("set/" + view.at("files").at("image").get<std::string>()));
        ASSERT_EQ(png.pixels.size(), size);
        for (std::size_t i = 0; i < size; ++i)
            EXPECT_EQ(static_cast<unsigned char>(rows[i]),
                      static_cast<int>(std::lround(255 * png.pixels[i])));
    }
    Front left(bag.messages.at("/cam0/camera_info").at(0).data);
    left.number<std::uint32_t>();
    left.header();
    EXPECT_EQ(left.aligned<std::uint32_t>(), 6U);
    EXPECT_EQ(left.aligned<std::uint32_t>(), 9U);
    EXPECT_EQ(left.aligned_text(), "plumb_bob");
    EXPECT_EQ(left.aligned<std::uint32_t>(), 5U);
    EXPECT_EQ(left.doubles<5>(), (std::array{-0.1, 0.02, 0.001, 0.002, 0.003}));
    EXPECT_EQ(left.doubles<9>(), (std::array<double, 9>{7, 0, 3.5, 0, 6, 2.5, 0, 0, 1}));
    EXPECT_EQ(left.doubles<9>(), (std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
    EXPECT_EQ(left.doubles<12>(), (std::array<double, 12>{7, 0, 3.5, 0, 0, 6, 2.5, 0, 0, 0, 1, 0}));
    Front right(bag.messages.at("/cam1/camera_info").at(0).data);
    right.number<std::uint32_t>();
    right.header();
    EXPECT_EQ(right.aligned<std::uint32_t>(), 6U);
    EXPECT_EQ(right.aligned<std::uint32_t>(), 8U);
    EXPECT_EQ(right.aligned_text(), "equidistant");
}

TEST_F(RosBag, FaultsAreNamedBeforehand) {
    expect_failure({"dataset", "vehicle.yaml", "-o", "set", "--format", "mcap", "--set",
                    "sensors[4].name=cam0"},
                   2, "the frame cam0");
    expect_failure({"dataset", "vehicle.yaml", "-o", "set", "--format", "mcap", "--set",
                    "sensors[0].rostopic=/depth"},
                   2, "the topic /depth");
    EXPECT_FALSE(exists("set"));
    write("early.csv", "-5000000000,0,0,0,1,0,0,0\n-4000000000,0.1,0,0,1,0,0,0\n");
    expect_failure({"dataset", "vehicle.yaml", "-o", "set", "--format", "mcap", "--exposure", "1",
                    "--quiet", "--set", "rig.trajectory={file: early.csv, format: euroc}"},
                   3, "before 1970");
}

}  // namespace
}  // namespace uw
