// ctest labels: unit threads
#include "core/base/parallel.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <xmmintrin.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/base/error.h"

namespace uw {
namespace {

TEST(Parallel, RunsEachIndexOnce) {
    for (const std::size_t count : {0UL, 1UL, 2UL, 1000UL}) {
        std::vector<std::atomic<int>> runs(count);
        parallel_for(count, [&](std::size_t i) { ++runs[i]; });
        EXPECT_TRUE(std::ranges::all_of(runs, [](const auto& n) { return n == 1; })) << count;
    }
}

TEST(Parallel, PassesOnWhatABodyThrows) {
    EXPECT_THROW(parallel_for(100,
                              [](std::size_t i) {
                                  if (i == 57) throw std::out_of_range("57");
                              }),
                 std::out_of_range);
}

// Whatever the settings were when the pool was used first: the same scene has the same bits.
TEST(Parallel, RunsWithTheCallersFloatingPointSettings) {
    const unsigned before = _mm_getcsr();
    const volatile double smallest = std::numeric_limits<double>::min();
    for (const unsigned mode : {_MM_FLUSH_ZERO_OFF, _MM_FLUSH_ZERO_ON, _MM_FLUSH_ZERO_OFF}) {
        _MM_SET_FLUSH_ZERO_MODE(mode);
        std::vector<double> halves(1000, -1);
        parallel_for(halves.size(), [&](std::size_t i) { halves[i] = 0.5 * smallest; });
        const double expected = mode == _MM_FLUSH_ZERO_ON ? 0 : 0x1p-1023;
        _mm_setcsr(before);
        EXPECT_EQ(std::ranges::count(halves, expected), 1000) << mode;
    }
}

TEST(Parallel, StopsWithinItsScope) {
    std::atomic<bool> stop = false;
    std::atomic<int> runs = 0;
    const auto run = [&] {
        parallel_for(1000, [&](std::size_t) {
            if (++runs == 10) stop = true;
        });
    };
    {
        const StopScope scope(stop);
        EXPECT_THROW(run(), Interrupted);
        EXPECT_LT(runs, 1000);
        EXPECT_THROW(with_threads(2, run), Interrupted);
        EXPECT_THROW(throw_if_stopped(), Interrupted);
        const std::atomic<bool> never = false;
        const StopScope within(never);
        EXPECT_NO_THROW(throw_if_stopped());
    }
    EXPECT_NO_THROW(throw_if_stopped());
    runs = 0;
    run();
    EXPECT_EQ(runs, 1000);
}

// Work inside a body asks by itself: on every thread, in loops within loops.
TEST(Parallel, TellsItsBodiesToStop) {
    std::atomic<bool> stop = false;
    std::atomic<int> steps = 0;
    const StopScope scope(stop);
    const auto work = [&](std::size_t) {
        for (;;) {
            throw_if_stopped();
            if (++steps == 1000) stop = true;
        }
    };
    const ThreadLimit all(4);
    EXPECT_THROW(parallel_for(4, [&](std::size_t) { parallel_for(4, work); }), Interrupted);
    EXPECT_LT(steps, 1000 + permitted_threads());
}

TEST(Parallel, WithThreadsLimitsThemForItself) {
    std::mutex mutex;
    std::set<std::thread::id> threads;
    with_threads(1, [&] {
        parallel_for(1000, [&](std::size_t) {
            const std::lock_guard lock(mutex);
            threads.insert(std::this_thread::get_id());
        });
    });
    EXPECT_EQ(threads, std::set{std::this_thread::get_id()});
    EXPECT_THROW(with_threads(2, [] { throw std::out_of_range("57"); }), std::out_of_range);
}

TEST(Parallel, ALimitOfOneThreadIsTheCallersAlone) {
    const ThreadLimit limit(1);
    std::mutex mutex;
    std::set<std::thread::id> threads;
    parallel_for(1000, [&](std::size_t) {
        const std::lock_guard lock(mutex);
        threads.insert(std::this_thread::get_id());
    });
    EXPECT_EQ(threads, (std::set{std::this_thread::get_id()}));
}

TEST(Parallel, LoopsMayStandInLoops) {
    const ThreadLimit all(0);
    std::atomic<int> sum = 0;
    parallel_for(20, [&](std::size_t i) { parallel_for(i, [&](std::size_t) { ++sum; }); });
    EXPECT_EQ(sum, 19 * 20 / 2);
}

int niceness_of_this_thread() {
    return getpriority(PRIO_PROCESS, 0);
}

// A niceness cannot be taken back: this test stays the last.
TEST(Parallel, WorkInTheBackgroundYieldsToTheRest) {
    const int usual = niceness_of_this_thread();
    int background = usual;
    std::mutex mutex;
    std::set<int> of_pool;
    std::thread([&] {
        work_in_background();
        background = niceness_of_this_thread();
        parallel_for(2000, [&](std::size_t) {
            const std::lock_guard lock(mutex);
            of_pool.insert(niceness_of_this_thread());
        });
    }).join();
    EXPECT_GE(background, 10);
    EXPECT_EQ(of_pool, std::set{background});
    EXPECT_EQ(niceness_of_this_thread(), usual);
}

}  // namespace
}  // namespace uw
