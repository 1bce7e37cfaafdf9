// ctest labels: metamorphic
// The programs of examples/datasets, on small sets of the scene that they name.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>

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
    std::string output_of(const std::string& program) const {
        const std::string command =
            fmt::format("PYTHONDONTWRITEBYTECODE=1 python3 '{}/examples/datasets/{}' '{}' 2>&1",
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

}  // namespace
}  // namespace uw
