// ctest labels: unit slow
// Runs of many files on a disk that becomes full on the way, or a user's share of it.
#include <gtest/gtest.h>

#include "tests/support/dataset/dataset_scenes.h"
#include "tests/support/faults/failing_calls.h"

namespace uw::test {
namespace {

namespace fs = std::filesystem;

class FullDisk : public FailingCallsTest, public testing::WithParamInterface<const char*> {
  protected:
    FullDisk() { write("moving.yaml", k_moving_scene); }

    /// How many files of the command's folder "part" are there in the end: whole ones alone.
    std::size_t fill(std::vector<std::string> command, std::size_t bytes) const {
        for (std::string& argument : command)
            if (argument.starts_with("FOLDER")) argument.replace(0, 6, "part");
        const Outcome outcome =
            run_with(std::string(GetParam()) + ":" + std::to_string(bytes), command);
        EXPECT_TRUE(outcome.has_failed);
        EXPECT_EQ(outcome.result.exit_code, 4) << outcome.result.err;
        EXPECT_EQ(line_count(outcome.result.err), 1) << outcome.result.err;
        return expect_whole("part", "whole");
    }
};

TEST_P(FullDisk, HoldsTheFramesThatFitted) {
    ASSERT_EQ(run({"render", "moving.yaml", "--frames", "0-6", "-o", "whole/#.exr", "--quiet",
                   "--layers", "all"})
                  .exit_code,
              0);
    const std::vector<std::string> command{"render",       "moving.yaml", "--frames", "0-6", "-o",
                                           "FOLDER/#.exr", "--quiet",     "--layers", "all"};
    const std::size_t frame = fs::file_size(folder_ / "whole/0.exr");
    EXPECT_EQ(fill(command, frame / 2), 0U);
    // Each of them has a preview and names beside it.
    const std::size_t some = fill(command, 3 * frame);
    EXPECT_GT(some, 0U);
    EXPECT_LT(some, files_in("whole").size());
}

TEST_P(FullDisk, HoldsTheViewsThatFittedAndCompletesThem) {
    const std::vector<std::string> command{"dataset",  "moving.yaml", "-o",
                                           "FOLDER",   "--frames",    "0-3",
                                           "--format", "png,exr,tum", "--quiet"};
    std::vector<std::string> whole = command, part = command;
    whole[3] = "whole";
    part[3] = "part";
    ASSERT_EQ(run(whole).exit_code, 0);
    std::size_t bytes = 0;
    for (const auto& [name, content] : files_in("whole")) bytes += content.size();
    const std::size_t some = fill(command, bytes / 2);
    EXPECT_GT(some, 0U);
    EXPECT_LT(some, files_in("whole").size());
    // Once there is room again.
    EXPECT_EQ(run(part).exit_code, 0);
    EXPECT_EQ(files_in("part"), files_in("whole"));
}

INSTANTIATE_TEST_SUITE_P(Kinds, FullDisk, testing::Values("space", "quota"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace uw::test
