// ctest labels: unit
#include "cli/console.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

#include "core/base/error.h"
#include "tests/support/temp_dir.h"

namespace uw {
namespace {

TEST(Console, OutputAndMessagesGoTheirWays) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    print_output("a result\n");
    print_message("a message\n");
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "a result\n");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "a message\n");
}

// Each in a process of its own, whose streams it may break.
TEST(Console, OutputThatIsLostIsAnError) {
    EXPECT_EXIT(
        {
            dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO);
            try {
                print_output("a result\n");
            } catch (const IoError& error) {
                print_message(error.what());
                _exit(4);
            }
            _exit(0);
        },
        testing::ExitedWithCode(4), "standard output: cannot write; is the disk full\\?");
}

TEST(Console, MessagesThatAreLostAreNone) {
    EXPECT_EXIT(
        {
            dup2(open("/dev/full", O_WRONLY), STDERR_FILENO);
            print_message("a message\n");
            _exit(7);
        },
        testing::ExitedWithCode(7), "");
}

TEST(Console, FilesDoNotTakeThePlaceOfClosedStreams) {
    EXPECT_EXIT(
        {
            for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) close(stream);
            prepare_streams();
            _exit(open("/dev/null", O_RDONLY) > STDERR_FILENO ? 7 : 1);
        },
        testing::ExitedWithCode(7), "");
}

TEST(Console, AFilesSizeLimitIsAFailedWrite) {
    const test::TempDir folder;
    EXPECT_EXIT(
        {
            prepare_streams();
            rlimit limit{};
            limit.rlim_cur = limit.rlim_max = 100;
            setrlimit(RLIMIT_FSIZE, &limit);
            std::ofstream out(folder / "file");
            out << std::string(1000, 'x') << std::flush;
            _exit(out ? 1 : 7);
        },
        testing::ExitedWithCode(7), "");
}

}  // namespace
}  // namespace uw
