// ctest labels: unit analytic slow
// The times of files of poses, to the last nanosecond, in everything that a data set writes of
// them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "core/scene/pose_file.h"
#include "tests/support/dataset/dataset_scenes.h"

namespace uw {
namespace {

using Stamps = std::vector<std::int64_t>;

constexpr std::int64_t k_second = 1'000'000'000;
constexpr std::int64_t k_2_to_53 = 9'007'199'254'740'992;

/// A stamp in seconds, written by other means than the program's.
std::string seconds_of(std::int64_t stamp) {
    std::string digits = std::to_string(stamp < 0 ? -stamp : stamp);
    if (digits.size() < 10) digits.insert(0, 10 - digits.size(), '0');
    return (stamp < 0 ? "-" : "") + digits.insert(digits.size() - 9, ".");
}

/// The file of poses with these times in the words of a format.
std::string poses_at(const Stamps& stamps, PoseFormat format) {
    std::string text = "# a line of comment\n";
    for (std::size_t i = 0; i < stamps.size(); ++i) {
        const std::string x = fmt::format("0.{:02}", i);
        text += format == PoseFormat::tum
                    ? fmt::format("{} {} 0 0 0 0 0 1\n", seconds_of(stamps[i]), x)
                    : fmt::format("{},{},0,0,1,0,0,0\n", stamps[i], x);
    }
    return text;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
        if (text[begin] != '#') lines.push_back(text.substr(begin, end - begin));
    return lines;
}

/// What stands in a line before a separator.
std::string first_of(const std::string& line, char separator) {
    return line.substr(0, line.find(separator));
}

class DatasetStamps : public test::DatasetTest {
  protected:
    /// A set of a camera that moves along a file; each pose is a frame.
    void make_along(const std::string& file, const std::string& format, std::size_t count,
                    const std::string& start = "") const {
        const std::string trajectory =
            fmt::format("{{file: {}, format: {}{}}}", file, format, start);
        write("along.yaml",
              "uwvdb: 1\ncamera:\n  resolution: [8, 6]\n  intrinsics: {fov_x: 40}\n  trajectory: " +
                  trajectory + "\n" + test::small_world() +
                  "lamps:\n  - {name: left, position: [-0.5, -0.2, 0], intensity: 50}\n"
                  "render: {samples: 1, times: trajectory}\n");
        make("along.yaml", "png,tum,euroc,kitti",
             {"--frames", fmt::format("0-{}", count - 1), "--exposure", "1"});
    }

    /// That all files of the set have these stamps; EuRoC's as its clock of 19 digits has them.
    void expect_stamps(const Stamps& stamps) const {
        const auto tum = lines_of(read("set/tum/groundtruth.txt"));
        const auto pictures = lines_of(read("set/tum/associations.txt"));
        const auto euroc = lines_of(read("set/mav0/state_groundtruth_estimate0/data.csv"));
        const auto names = lines_of(read("set/mav0/cam0/data.csv"));
        const auto kitti = lines_of(read("set/kitti/sequences/00/times.txt"));
        const auto manifest = lines_of(read("set/manifest.csv"));
        const auto json = Json::parse(read("set/manifest.json"));
        ASSERT_EQ(tum.size(), stamps.size());
        ASSERT_EQ(euroc.size(), stamps.size());
        ASSERT_EQ(names.size(), stamps.size());
        ASSERT_EQ(kitti.size(), stamps.size());
        ASSERT_EQ(manifest.size(), stamps.size() + 1);
        for (std::size_t i = 0; i < stamps.size(); ++i) {
            const std::int64_t stamp = stamps[i];
            const std::string seconds = seconds_of(stamp);
            EXPECT_EQ(first_of(tum[i], ' '), seconds);
            EXPECT_EQ(pictures[i], fmt::format("{0} rgb/{0}.png {0} depth/{0}.png", seconds));
            EXPECT_TRUE(exists("set/tum/rgb/" + seconds + ".png"));
            const std::int64_t in_euroc =
                stamp < k_second * k_second ? stamp + 1'400'000'000 * k_second : stamp;
            EXPECT_EQ(first_of(euroc[i], ','), std::to_string(in_euroc));
            EXPECT_EQ(names[i], fmt::format("{0},{0}.png", in_euroc));
            EXPECT_TRUE(exists(fmt::format("set/mav0/cam0/data/{}.png", in_euroc)));
            EXPECT_EQ(kitti[i], seconds_of(stamp - stamps.front()));
            EXPECT_NE(manifest[i + 1].find(fmt::format(",{},", stamp)), std::string::npos)
                << manifest[i + 1];
            EXPECT_EQ(json.at("views").at(i).at("stamp_ns").get<std::int64_t>(), stamp);
            const auto record = Json::parse(read(fmt::format("set/views/{:06}.json", i)));
            EXPECT_EQ(record.at("stamp_ns").get<std::int64_t>(), stamp);
        }
    }
};

const std::vector<Stamps> k_clocks{
    {1403636579763555584, 1403636579813555456, 1403636579863555585},  // EuRoC's own, of MH_01
    {1305031102175304000, 1305031102211214000},                       // of a TUM sequence
    {0, 1, 40'000'000},                                               // a clock that begins
    {-1'500'000'001, -1, 250'000'000},
    {k_2_to_53 - 1, k_2_to_53, k_2_to_53 + 1},  // beyond which doubles are not all whole
    {-k_2_to_53 - 1, -k_2_to_53 + 1},
    {333'333'333, 666'666'667, 1'000'000'000}};  // thirds of a second, rounded

// Every clock, in both formats that have times, in all that a set writes.
TEST_F(DatasetStamps, AreThoseOfTheFileOfPosesToTheNanosecond) {
    for (const PoseFormat format : {PoseFormat::tum, PoseFormat::euroc})
        for (const Stamps& stamps : k_clocks) {
            const bool is_tum = format == PoseFormat::tum;
            SCOPED_TRACE(fmt::format("{} {}", is_tum ? "tum" : "euroc", stamps.front()));
            write("poses", poses_at(stamps, format));
            make_along("poses", is_tum ? "tum" : "euroc", stamps.size());
            expect_stamps(stamps);
            std::filesystem::remove_all(folder_ / "set");
        }
}

// What a set has written is read again, and makes a set with the same stamps.
TEST_F(DatasetStamps, GoRoundThroughEveryFormatWithTimes) {
    for (const Stamps& stamps : {k_clocks[0], k_clocks[3]}) {
        write("poses", poses_at(stamps, PoseFormat::tum));
        make_along("poses", "tum", stamps.size());
        std::filesystem::rename(folder_ / "set/tum/groundtruth.txt", folder_ / "tum.txt");
        std::filesystem::rename(folder_ / "set/mav0/state_groundtruth_estimate0/data.csv",
                                folder_ / "euroc.csv");
        std::filesystem::remove_all(folder_ / "set");
        make_along("tum.txt", "tum", stamps.size());
        expect_stamps(stamps);
        std::filesystem::remove_all(folder_ / "set");
        make_along("euroc.csv", "euroc", stamps.size());
        // EuRoC's clock may have been moved, once and for all.
        Stamps moved = stamps;
        for (std::int64_t& stamp : moved)
            if (stamp < k_second * k_second) stamp += 1'400'000'000 * k_second;
        expect_stamps(moved);
        std::filesystem::remove_all(folder_ / "set");
    }
}

// Where the scene's time 0 lies does not change what the clock says, however far it is.
TEST_F(DatasetStamps, DoNotDependOnTheStart) {
    const Stamps stamps{1403636579763555584, 1403636579813555456, 1403636579863555585};
    write("poses", poses_at(stamps, PoseFormat::euroc));
    for (const char* start : {", start: 1400000000", ", start: 1403636579.5", ", start: 0"}) {
        SCOPED_TRACE(start);
        make_along("poses", "euroc", stamps.size(), start);
        expect_stamps(stamps);
        std::filesystem::remove_all(folder_ / "set");
    }
}

// Frames between the poses, 25 a second, have the clock's time, too: 40 ms each.
TEST_F(DatasetStamps, OfFramesByTheirRateAreCountedFromTheClocksStart) {
    write("poses", poses_at({1403636579763555584, 1403636580763555584}, PoseFormat::euroc));
    write("along.yaml",
          "uwvdb: 1\ncamera:\n  resolution: [8, 6]\n  intrinsics: {fov_x: 40}\n  trajectory: "
          "{file: poses, format: euroc}\n" +
              test::small_world() +
              "lamps:\n  - {name: left, position: [-0.5, -0.2, 0], intensity: 50}\n"
              "render: {samples: 1}\n");
    make("along.yaml", "tum,euroc,kitti", {"--frames", "0-3", "--exposure", "1"});
    Stamps stamps;
    for (int i = 0; i < 4; ++i) stamps.push_back(1403636579763555584 + i * 40'000'000);
    expect_stamps(stamps);
}

// Poses by frame, as COLMAP and nerfstudio have them, and keyframes have the scene's clock alone.
TEST_F(DatasetStamps, WithoutAClockAreTheScenesTimes) {
    write("images.txt",
          "1 1 0 0 0 0 0 0 1 f_0.png\n\n2 1 0 0 0 -0.1 0 0 1 f_1.png\n\n3 1 0 0 0 -0.2 0 0 1 "
          "f_2.png\n\n");
    make_along("images.txt", "colmap", 3);
    expect_stamps({0, 40'000'000, 80'000'000});
    std::filesystem::remove_all(folder_ / "set");
    write("transforms.json",
          R"({"frames": [
        {"file_path": "0.png", "transform_matrix": [[1,0,0,0],[0,-1,0,0],[0,0,-1,0],[0,0,0,1]]},
        {"file_path": "1.png", "transform_matrix": [[1,0,0,0.1],[0,-1,0,0],[0,0,-1,0],[0,0,0,1]]}]})");
    make_along("transforms.json", "nerfstudio", 2);
    expect_stamps({0, 40'000'000});
}

TEST_F(DatasetStamps, ThatEurocCannotTellAreRefusedBeforehand) {
    const std::int64_t edge = k_second * k_second;
    write("poses", poses_at({edge - 1, edge + 1}, PoseFormat::euroc));
    write("along.yaml",
          "uwvdb: 1\ncamera: {resolution: [8, 6], intrinsics: {fov_x: 40}, trajectory: {file: "
          "poses, format: euroc}}\nrender: {times: trajectory}\n");
    expect_failure({"dataset", "along.yaml", "-o", "set", "--format", "euroc", "--frames", "0-1"},
                   2, "are on both sides of 10^18");
    EXPECT_FALSE(exists("set"));
}

}  // namespace
}  // namespace uw
