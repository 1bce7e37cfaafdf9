// ctest labels: unit slow
// What fails in commands other than `render` (failing_calls.cpp).
#include <gtest/gtest.h>

#include "tests/support/faults/failing_calls.h"

namespace uw::test {
namespace {

struct NamedRun {
    const char* name;
    FaultyRun run;
};

class FailingCommand : public FailingCallsTest, public testing::WithParamInterface<NamedRun> {
  protected:
    /// Each kind of call fails at least as often as there are files.
    void expect_no_harm(const std::string& kind) const {
        const FaultyRun& faulty = GetParam().run;
        const int calls = fail_each(faulty, kind, {4});
        const int files = static_cast<int>(faulty.outputs.size());
        EXPECT_GE(calls, files);
    }
};

TEST_P(FailingCommand, LosesNothingWhereWritingFails) {
    expect_no_harm("write");
}

TEST_P(FailingCommand, LosesNothingWhereFilesCannotBeMade) {
    expect_no_harm("open");
}

TEST_P(FailingCommand, LosesNothingWhereRenamingFails) {
    expect_no_harm("rename");
}

TEST_P(FailingCommand, LosesNothingWhereTheDiskFails) {
    expect_no_harm("fsync");
}

INSTANTIATE_TEST_SUITE_P(
    Commands, FailingCommand,
    testing::Values(
        NamedRun{"water",
                 {{"water", "jerlov-II", "--csv", "w", "--svg", "w.svg"},
                  {"w-coefficients.csv", "w-vsf.csv", "w.svg"},
                  {}}},
        NamedRun{"calibration",
                 {{"calibration", "scene.yaml", "--to", "opencv", "-o", "c.yaml"}, {"c.yaml"}, {}}},
        NamedRun{"validate",
                 {{"validate", "scene.yaml", "--set", "camera.resolution=[6, 4]", "--report",
                   "r.html", "--quiet"},
                  {"r.html"},
                  {"r.html"}}},
        NamedRun{"sweep",
                 {{"sweep", "scene.yaml", "--set", "lamps[0].position[0]=-0.5:0:0.5", "--size",
                   "16x9", "-o", "s.csv", "--quiet"},
                  {"s.csv", "s.svg"},
                  {}}}),
    [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace uw::test
