// ctest labels: unit
#include "cli/process.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

namespace uw {
namespace {

// Each in a process of its own, which the signal may end. It ends without the destructors of
// libraries, whose threads a forked process does not have.
class StopSignal : public testing::TestWithParam<int> {};

TEST_P(StopSignal, EndsTheProgramAtOnceBeforeAnythingIsWritten) {
    EXPECT_EXIT(
        {
            install_stop_signal();
            std::raise(GetParam());
            std::_Exit(0);
        },
        testing::ExitedWithCode(130), "uwvdb: interrupted; nothing was written");
}

TEST_P(StopSignal, AsksForAnOrderlyStopFromThenOn) {
    EXPECT_EXIT(
        {
            install_stop_signal();
            begin_orderly_stop();
            const bool before = stop_flag();
            std::raise(GetParam());
            std::_Exit(!before && stop_flag() ? 7 : 1);
        },
        testing::ExitedWithCode(7), "^$");
}

TEST_P(StopSignal, ASecondOneEndsTheProgramAtOnce) {
    EXPECT_EXIT(
        {
            install_stop_signal();
            begin_orderly_stop();
            std::raise(GetParam());
            std::raise(GetParam());
            std::_Exit(0);
        },
        testing::KilledBySignal(GetParam()), "^$");
}

INSTANTIATE_TEST_SUITE_P(Signals, StopSignal, testing::Values(SIGINT, SIGTERM));

TEST(StopSignalAlone, NothingWasAskedFor) {
    EXPECT_FALSE(stop_flag());
}

}  // namespace
}  // namespace uw
