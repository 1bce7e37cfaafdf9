// ctest labels: unit slow
#include "tests/support/faults/failing_calls.h"

#include <gtest/gtest.h>

namespace uw::test {
namespace {

/// Calls of `render`, with all that it writes, over files that were there before.
class FailingCalls : public FailingCallsTest {
  protected:
    const FaultyRun k_render{{"render", "scene.yaml", "-o", "out.exr", "--stats", "out.json",
                              "--numbers", "out.csv", "--quiet", "--layers", "all"},
                             {"out.exr", "out.png", "out.json", "out.csv", "out_ids.csv"},
                             {"out.json"}};
};

TEST_F(FailingCalls, NothingIsLostWhereWritingFails) {
    EXPECT_GE(fail_each(k_render, "write", {4}), 5);  // one for each file at least
}

TEST_F(FailingCalls, NothingIsLostWhereFilesCannotBeMade) {
    EXPECT_GE(fail_each(k_render, "open", {4}), 5);
}

TEST_F(FailingCalls, NothingIsLostWhereRenamingFails) {
    EXPECT_EQ(fail_each(k_render, "rename", {4}), 5);
}

TEST_F(FailingCalls, AStopLeavesAllFilesOrNone) {
    FaultyRun with_light = k_render;
    with_light.command.insert(with_light.command.end(), {"--irradiance-vdb", "light.vdb"});
    with_light.outputs.push_back("light.vdb");
    with_light.times.push_back("light.vdb");
    EXPECT_GE(fail_each(with_light, "stop", {0, 130}), 10);
}

// Files that replace others are flushed before they do.
TEST_F(FailingCalls, NothingIsLostWhereTheDiskFails) {
    EXPECT_EQ(fail_each(k_render, "fsync", {4}), 5);
}

// Where there is not enough memory: refused, an error of one line, or done without.
TEST_F(FailingCalls, MemoryThatIsNotThere) {
    EXPECT_GE(fail_each(k_render, "allocate", {0, 1, 3}), 1);
}

// Which Embree asks for; it must not be waited for where it gave up (EmbreeScene::commit).
TEST_F(FailingCalls, MemoryThatCannotBeMapped) {
    EXPECT_GE(fail_each(k_render, "map", {0, 1, 3}), 5);
}

// Its work is done by the others, or Embree ends the run with a line where it has none.
TEST_F(FailingCalls, ThreadsThatCannotBeStarted) {
    EXPECT_GE(fail_each(k_render, "thread", {0, 1}), 2);
}

}  // namespace
}  // namespace uw::test
