// ctest labels: unit slow
// Runs of many files that are stopped by Ctrl-C as one of them is written.
#include <gtest/gtest.h>

#include "tests/support/dataset/dataset_scenes.h"
#include "tests/support/faults/failing_calls.h"

namespace uw::test {
namespace {

class StoppedRuns : public FailingCallsTest {
  protected:
    StoppedRuns() { write("moving.yaml", k_moving_scene); }

    static std::vector<std::string> into(const std::string& folder,
                                         std::vector<std::string> command) {
        for (std::string& argument : command)
            if (argument.starts_with("FOLDER")) argument.replace(0, 6, folder);
        return command;
    }

    /// Stops the command at one write after the other, and continues it. Returns how many writes
    /// there are.
    int stop_each(const std::vector<std::string>& command, const std::string& continuing_option) {
        EXPECT_EQ(run(into("whole", command)).exit_code, 0);
        std::vector<std::string> continuing = into("part", command);
        if (!continuing_option.empty()) continuing.push_back(continuing_option);
        constexpr int k_most = 2000, k_all_of = 12;
        int stopped = 0;
        for (int n = 1; n < k_most; n += n < k_all_of ? 1 : n / 3) {
            SCOPED_TRACE(n);
            std::filesystem::remove_all(folder_ / "part");
            const Outcome outcome = run_with("stop:" + std::to_string(n), into("part", command));
            if (!outcome.has_failed) {
                EXPECT_GE(stopped, 5);
                return n;
            }
            // Where the last file is being written there is nothing left to stop.
            const ProgramResult& result = outcome.result;
            EXPECT_TRUE(result.exit_code == 130 || result.exit_code == 0) << result.exit_code;
            EXPECT_EQ(line_count(result.err), result.exit_code == 0 ? 0 : 1) << result.err;
            const std::size_t there = expect_whole("part", "whole");
            if (result.exit_code == 130) {
                ++stopped;
                EXPECT_NE(result.err.find("interrupted; "), std::string::npos) << result.err;
                if (result.err.find("nothing was written") != std::string::npos) {
                    EXPECT_EQ(there, 0U);
                    EXPECT_FALSE(exists("part"));
                }
                EXPECT_EQ(run(continuing).exit_code, 0);
            }
            EXPECT_EQ(files_in("part"), files_in("whole"));
        }
        ADD_FAILURE() << "more than " << k_most << " writes";
        return k_most;
    }
};

TEST_F(StoppedRuns, KeepTheFramesThatAreWritten) {
    // Each frame has an image, a preview and names.
    EXPECT_GE(stop_each({"render", "moving.yaml", "--frames", "0-3", "-o", "FOLDER/#.exr",
                         "--quiet", "--layers", "all"},
                        "--resume"),
              12);
}

TEST_F(StoppedRuns, KeepTheViewsThatAreWritten) {
    EXPECT_GE(stop_each({"dataset", "moving.yaml", "-o", "FOLDER", "--frames", "0-3", "--format",
                         "png,exr,tum", "--quiet"},
                        ""),
              12);
}

}  // namespace
}  // namespace uw::test
