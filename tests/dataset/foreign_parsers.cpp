// ctest labels: unit slow
// Sets as the programs that they are written for find their files and take them apart: Kalibr's
// kalibr_bagcreater, nerfstudio's parser of transforms.json, pykitti's loader of odometry.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include "core/base/json.h"
#include "core/image/image_file.h"
#include "core/scene/trajectory.h"
#include "tests/support/dataset/dataset_scenes.h"

namespace uw {
namespace {

namespace fs = std::filesystem;

/// The words of a text between blanks.
std::vector<double> doubles_in(const std::string& text) {
    std::istringstream cells(text);
    std::vector<double> numbers;
    for (double number = 0; cells >> number;) numbers.push_back(number);
    return numbers;
}

std::vector<std::string> lines_in(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

class ForeignParsers : public test::DatasetTest {
  protected:
    /// The PNG files of a folder, in the order of their names.
    std::vector<fs::path> images_in(const std::string& folder) const {
        std::vector<fs::path> files;
        for (const auto& entry : fs::directory_iterator(folder_ / folder))
            if (entry.path().extension() == ".png") files.push_back(entry.path());
        std::ranges::sort(files);
        return files;
    }
};

class KalibrsBag : public ForeignParsers {
  protected:
    struct Stamp {
        long seconds = 0, nanoseconds = 0;
    };

    /// The time in a name: its last nine digits are nanoseconds, seconds the rest.
    static Stamp stamp_of(const fs::path& image) {
        const std::string name = image.stem().string();
        EXPECT_EQ(name.size(), 19U);
        const std::size_t at = name.size() - std::min<std::size_t>(name.size(), 9);
        return {std::stol(name.substr(0, at)), std::stol(name.substr(at))};
    }
};

TEST_F(KalibrsBag, HasTheTimesOfTheFrames) {
    make("moving.yaml", "png,euroc", {"--frames", "0,2-6"});
    const std::vector<fs::path> images = images_in("set/mav0/cam0/data");
    const std::vector<int> frames{0, 2, 3, 4, 5, 6};
    ASSERT_EQ(images.size(), frames.size());
    for (std::size_t i = 0; i < images.size(); ++i) {
        const Stamp stamp = stamp_of(images[i]);
        EXPECT_NEAR(static_cast<double>(stamp.seconds - 1'400'000'000) +
                        1e-9 * static_cast<double>(stamp.nanoseconds),
                    frames[i] / 6.0, 1e-9);
        EXPECT_TRUE(read(fs::relative(images[i], folder_.path()).string()) ==
                    read(fmt::format("set/images/{:06}.png", frames[i])));
    }
}

// The tables' first columns are those times, so that tools that go by them find images and poses.
TEST_F(KalibrsBag, HasTheTimesOfTheTables) {
    make("moving.yaml", "euroc", {"--frames", "4-6"});
    const std::vector<std::string> table = lines_in(read("set/mav0/cam0/data.csv"));
    const std::vector<std::string> truth =
        lines_in(read("set/mav0/state_groundtruth_estimate0/data.csv"));
    ASSERT_EQ(table.size(), 4U);
    ASSERT_EQ(truth.size(), 4U);
    const std::vector<fs::path> images = images_in("set/mav0/cam0/data");
    ASSERT_EQ(images.size(), 3U);
    for (std::size_t i = 0; i < images.size(); ++i) {
        const std::string stamp = images[i].stem().string();
        EXPECT_EQ(table[i + 1], fmt::format("{0},{0}.png", stamp));
        EXPECT_TRUE(truth[i + 1].starts_with(stamp + ","));
    }
    // In doubles two intervals of 1/6 s are 5.999999999999999 a second.
    EXPECT_NE(read("set/mav0/cam0/sensor.yaml").find("rate_hz: 6\n"), std::string::npos);
}

class NerfstudiosParser : public ForeignParsers {
  protected:
    /// The set as the parser has it: a value of a camera stands at the top, or in every frame.
    struct Parsed {
        std::string model;  // of all images; none is said: a perspective
        std::vector<std::string> images, depths, masks;
        std::vector<double> fx, k1;
        Json frames;
    };

    Parsed parsed() const {
        const Json meta = Json::parse(read("set/transforms.json"));
        Parsed set;
        set.model = meta.value("camera_model", "perspective");
        set.frames = meta.at("frames");
        const bool has_one_distortion = meta.contains("k1");
        for (const Json& frame : set.frames) {
            set.images.push_back(frame.at("file_path"));
            for (const char* key : {"fl_y", "cx", "cy", "w", "h"})
                EXPECT_TRUE(meta.contains(key) || frame.contains(key)) << key;
            set.fx.push_back(meta.contains("fl_x") ? meta.at("fl_x") : frame.at("fl_x"));
            set.k1.push_back(has_one_distortion ? meta.at("k1") : frame.value("k1", Json(0.0)));
            if (frame.contains("depth_file_path"))
                set.depths.push_back(frame.at("depth_file_path"));
            if (frame.contains("mask_path")) set.masks.push_back(frame.at("mask_path"));
        }
        // Every image has them, or none.
        EXPECT_TRUE(set.depths.empty() || set.depths.size() == set.images.size());
        EXPECT_TRUE(set.masks.empty() || set.masks.size() == set.images.size());
        for (const auto& list : {set.images, set.depths, set.masks})
            for (const std::string& file : list) EXPECT_TRUE(exists("set/" + file)) << file;
        return set;
    }
};

TEST_F(NerfstudiosParser, FindsTheLensOfARig) {
    make("pair.yaml", "nerfstudio");
    EXPECT_EQ(parsed().model, "OPENCV");
    EXPECT_EQ(parsed().fx, (std::vector<double>{36, 36}));
    const std::string fisheye = "distortion={model: fisheye, k: [0.01, 0, 0, 0]}";
    fs::remove_all(folder_ / "set");
    make("pair.yaml", "nerfstudio",
         {"--set", "cameras[0]." + fisheye, "--set", "cameras[1]." + fisheye});
    EXPECT_EQ(parsed().model, "OPENCV_FISHEYE");
    EXPECT_EQ(parsed().k1, (std::vector<double>{0.01, 0.01}));
    fs::remove_all(folder_ / "set");
    make("pair.yaml", "nerfstudio", {"--set", "cameras[0]." + fisheye});
    const Parsed mixed = parsed();
    EXPECT_EQ(mixed.model, "perspective");
    EXPECT_EQ(mixed.frames.at(0).at("camera_model"), "OPENCV_FISHEYE");
    EXPECT_EQ(mixed.frames.at(1).at("camera_model"), "OPENCV");
    EXPECT_EQ(mixed.k1, (std::vector<double>{0.01, 0}));
    EXPECT_NE(read("set/README.md").find("read as perspective"), std::string::npos);
}

TEST_F(NerfstudiosParser, FindsTheLensOfOneCamera) {
    make("scene.yaml", "nerfstudio",
         {"--set", "camera.distortion={model: fisheye, k: [0.01, 0, 0, 0]}"});
    const Parsed set = parsed();
    EXPECT_EQ(set.model, "OPENCV_FISHEYE");
    EXPECT_EQ(set.k1, (std::vector<double>{0.01}));
    EXPECT_TRUE(set.depths.empty());
    EXPECT_TRUE(set.masks.empty());
}

TEST_F(NerfstudiosParser, TakesDepthsForMillimetresAndMasksForWhatCounts) {
    make(
        "moving.yaml", "exr,depth,mask,nerfstudio",
        {"--frames", "0-1", "--set", "geometry=[{type: box, min: [0, 0, 2], max: [0.5, 0.5, 3]}]"});
    const Parsed set = parsed();
    ASSERT_EQ(set.depths.size(), 2U);
    ASSERT_EQ(set.masks.size(), 2U);
    int seen = 0, unseen = 0;
    for (std::size_t i = 0; i < 2; ++i) {
        const test::ImageFile exr = truth(fmt::format("{:06}", i));
        const PixelImage depth = read_image(folder_ / "set" / set.depths[i]);
        const PixelImage mask = read_image(folder_ / "set" / set.masks[i]);
        ASSERT_EQ(depth.pixels.size(), 1200U);
        ASSERT_EQ(mask.pixels.size(), 1200U);
        for (std::size_t k = 0; k < 1200; ++k) {
            const bool counts = mask.pixels[k] > 0;
            EXPECT_EQ(counts, exr.channels.at("id.V")[k] > 0);
            (counts ? seen : unseen) += 1;
            const double metres = std::round(65535.0 * depth.pixels[k]) * 0.001;
            EXPECT_NEAR(metres, counts ? exr.channels.at("depth.Z")[k] : 0, 0.000501);
        }
    }
    EXPECT_GT(seen, 0);
    EXPECT_GT(unseen, 0);
}

// It does not read the scale of other depths: the file has the value that is to be given.
TEST_F(NerfstudiosParser, IsToBeToldOfAnotherScale) {
    make("moving.yaml", "depth,nerfstudio", {"--frames", "0", "--depth-scale", "2000"});
    EXPECT_EQ(Json::parse(read("set/transforms.json")).at("depth_unit_scale_factor"), 0.0005);
    EXPECT_NE(read("set/README.md").find("--depth-unit-scale-factor"), std::string::npos);
}

// Points of the PLY are in the world of the poses: each is in some image, in front of its camera.
TEST_F(NerfstudiosParser, FindsPointsInTheWorldOfThePoses) {
    make("moving.yaml", "colmap,nerfstudio");
    const Parsed set = parsed();
    const Json meta = Json::parse(read("set/transforms.json"));
    const std::vector<std::string> lines =
        lines_in(read("set/" + meta.at("ply_file_path").get<std::string>()));
    ASSERT_EQ(lines.front(), "ply");
    const auto end = std::ranges::find(lines, "end_header");
    ASSERT_NE(end, lines.end());
    const auto count = std::ranges::find_if(
        lines, [](const std::string& line) { return line.starts_with("element vertex "); });
    ASSERT_NE(count, lines.end());
    EXPECT_EQ(std::stol(count->substr(15)), lines.end() - end - 1);
    EXPECT_GT(lines.end() - end, 1000);
    for (auto line = end + 1; line != lines.end(); ++line) {
        const std::vector<double> vertex = doubles_in(*line);
        ASSERT_EQ(vertex.size(), 6U);
        EXPECT_TRUE(std::ranges::all_of(vertex.begin() + 3, vertex.end(),
                                        [](double v) { return v >= 0 && v <= 255; }));
        const bool is_seen = std::ranges::any_of(set.frames, [&](const Json& frame) {
            // Columns are the camera's axes: x right, y up, z backward.
            std::array<double, 3> q{};
            for (std::size_t axis = 0; axis < 3; ++axis)
                for (std::size_t row = 0; row < 3; ++row) {
                    const Json& m = frame.at("transform_matrix").at(row);
                    q[axis] += m.at(axis).get<double>() * (vertex[row] - m.at(3).get<double>());
                }
            const double x = 36 * q[0] / -q[2] + 19, y = 35 * -q[1] / -q[2] + 15.5;
            return q[2] < 0 && x > -1e-3 && x < 40 + 1e-3 && y > -1e-3 && y < 30 + 1e-3;
        });
        EXPECT_TRUE(is_seen) << *line;
    }
}

class PykittisOdometry : public ForeignParsers {
  protected:
    const std::string sequence_ = "set/kitti/sequences/00/";

    /// Lines of a key, its colon, a blank and numbers.
    std::map<std::string, std::vector<double>> calibration() const {
        std::map<std::string, std::vector<double>> values;
        for (const std::string& line : lines_in(read(sequence_ + "calib.txt"))) {
            const std::size_t blank = line.find(' ');
            EXPECT_NE(blank, std::string::npos) << line;
            std::string key = line.substr(0, blank);
            while (key.ends_with(':')) key.pop_back();
            values[key] = doubles_in(line.substr(blank));
        }
        for (const char* key : {"P0", "P1", "P2", "P3", "Tr"})
            EXPECT_EQ(values[key].size(), 12U) << key;
        return values;
    }
    /// The x of a camera's centre less that of camera 0's.
    static double offset_of(const std::vector<double>& projection) {
        return -projection.at(3) / projection.at(0);
    }
    std::vector<double> times() const {
        std::vector<double> seconds;
        for (const std::string& line : lines_in(read(sequence_ + "times.txt")))
            seconds.push_back(std::stod(line));
        return seconds;
    }
    std::vector<std::vector<double>> poses() const {
        std::vector<std::vector<double>> rows;
        for (const std::string& line : lines_in(read("set/kitti/poses/00.txt")))
            rows.push_back(doubles_in(line));
        return rows;
    }
};

TEST_F(PykittisOdometry, FindsFramesTimesAndPoses) {
    make("moving.yaml", "png,kitti", {"--frames", "1-3,6"});
    const std::vector<int> frames{1, 2, 3, 6};
    const std::vector<fs::path> images = images_in(sequence_ + "image_2");
    const std::vector<double> seconds = times();
    const std::vector<std::vector<double>> rows = poses();
    ASSERT_EQ(images.size(), 4U);
    ASSERT_EQ(seconds.size(), 4U);
    ASSERT_EQ(rows.size(), 4U);
    EXPECT_EQ(rows[0], (std::vector<double>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}));
    Vector3 at_first(0.0), last(0.0);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(images[i].filename().string(), fmt::format("{:06}.png", i));
        EXPECT_TRUE(read(sequence_ + "image_2/" + images[i].filename().string()) ==
                    read(fmt::format("set/images/{:06}.png", frames[i])));
        EXPECT_NEAR(seconds[i], (frames[i] - 1) / 6.0, 1e-9);
        // The scene's camera moves straight, at a steady speed.
        ASSERT_EQ(rows[i].size(), 12U);
        const Vector3 centre(rows[i][3], rows[i][7], rows[i][11]);
        EXPECT_NEAR(glm::length(centre), std::sqrt(0.3) * seconds[i], 1e-9);
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) {
                double product = 0;
                for (std::size_t column = 0; column < 3; ++column)
                    product += rows[i][static_cast<std::size_t>(4 * a) + column] *
                               rows[i][static_cast<std::size_t>(4 * b) + column];
                EXPECT_NEAR(product, a == b ? 1 : 0, 1e-9);
            }
        if (i == 1) at_first = glm::normalize(centre);
        if (i == 3) last = glm::normalize(centre);
    }
    EXPECT_LT(glm::length(last - at_first), 1e-9);
    const auto p = calibration();
    for (const char* key : {"P0", "P1", "P2", "P3"})
        EXPECT_EQ(p.at(key), (std::vector<double>{36, 0, 18.5, 0, 0, 35, 15, 0, 0, 0, 1, 0}));
}

TEST_F(PykittisOdometry, FindsBothCamerasOfAPair) {
    make("pair.yaml", "png,kitti");
    for (const auto& [folder, camera] : {std::pair("image_2", "left"), {"image_3", "right"}}) {
        const std::vector<fs::path> images = images_in(sequence_ + folder);
        ASSERT_EQ(images.size(), 1U);
        EXPECT_TRUE(read(fs::relative(images.front(), folder_.path()).string()) ==
                    read(fmt::format("set/images/{}/000000.png", camera)));
    }
    EXPECT_EQ(times(), std::vector<double>{0});
    ASSERT_EQ(poses().size(), 1U);
    const auto p = calibration();
    EXPECT_EQ(offset_of(p.at("P0")), 0);
    EXPECT_NEAR(offset_of(p.at("P1")), 0.1, 1e-12);
    EXPECT_NEAR(offset_of(p.at("P3")) - offset_of(p.at("P2")), 0.1, 1e-12);
    EXPECT_EQ(p.at("P2")[2], 18.5);  // the first pixel's centre is (0, 0)
    EXPECT_EQ(p.at("P3")[2], 17.5);
}

}  // namespace
}  // namespace uw
