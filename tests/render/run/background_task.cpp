// ctest labels: unit threads
#include "render/run/background_task.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <optional>
#include <stdexcept>

#include "core/base/error.h"

namespace uw {
namespace {

TEST(BackgroundTask, RunsBesideItsCaller) {
    std::promise<void> go;
    bool is_done = false;
    BackgroundTask task([&] {
        go.get_future().wait();
        is_done = true;
    });
    EXPECT_FALSE(task.is_done());
    go.set_value();
    task.finish();
    EXPECT_TRUE(is_done);
    EXPECT_TRUE(task.is_done());
}

TEST(BackgroundTask, HandsItsFaultToTheCaller) {
    BackgroundTask task([] { throw std::runtime_error("fault"); });
    EXPECT_THROW(task.finish(), std::runtime_error);
}

TEST(BackgroundTask, IsStoppedAsItsCaller) {
    const std::atomic<bool> stop = true;
    std::optional<BackgroundTask> task;
    {
        const StopScope scope(stop);
        task.emplace(throw_if_stopped);
    }
    EXPECT_THROW(task->finish(), Interrupted);
    BackgroundTask unstopped(throw_if_stopped);
    EXPECT_NO_THROW(unstopped.finish());
}

TEST(BackgroundTask, IsWaitedForWithoutAWord) {
    bool is_done = false;
    {
        const BackgroundTask task([&] { is_done = true; });
        const BackgroundTask faulty([] { throw std::runtime_error("fault"); });
    }
    EXPECT_TRUE(is_done);
}

}  // namespace
}  // namespace uw
