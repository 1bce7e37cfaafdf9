// ctest labels: metamorphic
// The programs of docs/examples/datasets, on small sets of the scene that they name.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/dataset/dataset_scenes.h"

namespace uw {
namespace {

class DatasetExamples : public test::DatasetTest {
  protected:
    void make_wreck(const std::string& formats, const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{"--size", "96x72", "--quality", "draft"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        make(UWVDB_SOURCE_DIR "/assets/scenes/wreck.yaml", formats, arguments);
    }
    /// What one of the programs prints about the set.
    std::string output_of(const std::string& program, const std::string& environment = "") const {
        // The packages' Python has NumPy; another one may come before it in PATH.
        const std::string command =
            environment + fmt::format(
                              "PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "
                              "'{}/docs/examples/datasets/{}' '{}' 2>&1",
                              UWVDB_SOURCE_DIR, program, (folder_ / "set").string());
        FILE* const pipe = ::popen(command.c_str(), "r");
        std::string text;
        for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
        EXPECT_EQ(::pclose(pipe), 0) << text;
        return text;
    }
    /// The numbers in a text, in their order.
    static std::vector<double> numbers_in(const std::string& text) {
        std::vector<double> numbers;
        for (const char* at = text.c_str(); *at != '\0';) {
            char* end = nullptr;
            const double value = std::strtod(at, &end);
            if (end == at) {
                ++at;
                continue;
            }
            numbers.push_back(value);
            at = end;
        }
        return numbers;
    }
};

TEST_F(DatasetExamples, RestorationPairs) {
    make_wreck("clean", {"--frames", "20-23", "--cameras", "left"});
    const std::string text = output_of("restoration_pairs.py");
    const std::vector<double> n = numbers_in(text);  // pairs, training, dB as it is, dB fitted
    ASSERT_EQ(n.size(), 4U) << text;
    EXPECT_EQ(n[0], 4);
    EXPECT_EQ(n[1], 3);
    EXPECT_GT(n[3], n[2]) << text;
}

TEST_F(DatasetExamples, FlowPairs) {
    make_wreck("png,flow", {"--frames", "20-22", "--cameras", "left"});
    const std::string text = output_of("flow_pairs.py");
    const std::vector<double> n = numbers_in(text);  // pairs, flow, difference still, warped
    ASSERT_EQ(n.size(), 4U) << text;
    EXPECT_EQ(n[0], 2);
    EXPECT_GT(n[1], 1);
    EXPECT_LT(n[3], 0.6 * n[2]) << text;  // most of the difference is motion
}

TEST_F(DatasetExamples, StereoDepth) {
    make_wreck("png,disparity,depth", {"--frames", "24"});
    const std::string text = output_of("stereo_depth.py");
    const std::vector<double> n = numbers_in(text);  // pairs, depths, per cent, 3 px, good, all
    ASSERT_EQ(n.size(), 6U) << text;
    EXPECT_EQ(n[0], 1);
    EXPECT_GT(n[1], 500);
    EXPECT_LT(n[2], 0.05) << text;  // half a millimetre of depth at some 2 m
}

// COLMAP is played by a program that hands back the true model: then nothing is off but what the
// set's camera leaves of the rays through the port, whatever the lens that was fitted to them.
TEST_F(DatasetExamples, ColmapPosesOfFittedPinholes) {
    std::filesystem::create_directory(folder_ / "bin");
    std::ofstream(folder_ / "bin/colmap")
        << "#!/bin/sh\n[ $1 = model_converter ] || exit 0\nwhile [ $# -gt 1 ]; do\n"
           "[ $1 = --output_path ] && cp '"
        << (folder_ / "set/sparse/0").string() << "'/*.txt \"$2\"\nshift\ndone\nexit 0\n";
    std::filesystem::permissions(folder_ / "bin/colmap", std::filesystem::perms::owner_all);
    const std::string port = "camera.port={type: flat, distance: 0.05, thickness: 0.02}";
    const std::string fisheye = "camera.distortion={model: fisheye, k1: 0.01}";
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{},
          {"--set", port, "--pinhole-fit"},
          {"--set", port, "--set", fisheye, "--pinhole-fit"}}) {
        std::filesystem::remove_all(folder_ / "set");
        std::filesystem::remove_all(folder_ / "set-colmap");
        std::vector<std::string> arguments{"--size", "96x72",    "--quality",
                                           "draft",  "--frames", "0-3"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        make(UWVDB_SOURCE_DIR "/assets/scenes/reconstruction.yaml", "png,colmap", arguments);
        const std::string path = fmt::format("PATH='{}:'$PATH ", (folder_ / "bin").string());
        const std::string text = output_of("colmap_poses.py", path);
        // Images, images, mm RMS, mm at most, per cent, metres, degrees RMS, at most, px.
        const std::vector<double> n = numbers_in(text);
        ASSERT_EQ(n.size(), 9U) << text;
        EXPECT_EQ(n[0], 4);
        EXPECT_EQ(n[1], 4);
        EXPECT_EQ(n[3], 0) << text;
        EXPECT_LT(n[7], 1e-3) << text;
        // What COLMAP calls the error of a point is the mean over its track, by the program's own
        // camera: an RMS is no less, and no many times as much.
        double sum = 0, count = 0;
        std::ifstream points(folder_ / "set/sparse/0/points3D.txt");
        for (std::string line; std::getline(points, line);) {
            if (line.starts_with('#')) continue;
            const std::vector<double> p = numbers_in(line);
            const double views = 0.5 * static_cast<double>(p.size() - 8);
            sum += views * p[7];
            count += views;
        }
        ASSERT_GT(count, 100);
        const double mean = sum / count;
        EXPECT_GE(n[8], mean - 1e-3) << text;  // as it is printed
        EXPECT_LT(n[8], 3 * mean + 1e-3) << text;
        EXPECT_LT(n[8], 0.5) << text;
    }
}

}  // namespace
}  // namespace uw
