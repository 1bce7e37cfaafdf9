#include <emmintrin.h>
#include <sys/resource.h>

#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <set>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"

// core/base/parallel.h for the thread sanitizer (UWVDB_STD_THREADS), in place of parallel.cpp: each
// loop runs on threads of the standard library that it starts and joins. The sanitizer sees both;
// what oneTBB's threads, which are compiled without it, tell each other it does not see, and would
// take whatever they do one after the other for a race.
namespace uw {

namespace {

// The loops of oneTBB within libraries run on the calling thread alone.
const tbb::global_control no_tbb_threads(tbb::global_control::max_allowed_parallelism, 1);

// Fewer processors make as many races as there are threads.
constexpr int k_fewest_threads = 4;

std::mutex limits_mutex;
std::multiset<int> limits;

thread_local int arena_threads = 0;      // of with_threads; 0: not in it
thread_local bool is_in_a_loop = false;  // of several threads: loops within run on one

int threads_here() {
    if (is_in_a_loop) return 1;
    return arena_threads > 0 ? std::min(arena_threads, permitted_threads()) : permitted_threads();
}

/// What the threads of a loop share.
struct Loop {
    std::size_t count;
    const std::function<void(std::size_t)>* body;
    const std::atomic<bool>* stop;
    unsigned float_settings;
    std::atomic<std::size_t> next{0};
    std::mutex mutex{};
    std::exception_ptr fault{};

    void run() {
        const StopScope scope(stop);
        _mm_setcsr(float_settings);
        try {
            for (std::size_t i = next++; i < count; i = next++) {
                throw_if_stopped();
                (*body)(i);
            }
        } catch (...) {
            next = count;
            const std::lock_guard lock(mutex);
            if (!fault) fault = std::current_exception();
        }
    }
};

}  // namespace

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
    Loop loop{count, &body, StopScope::of_this_thread(), _mm_getcsr()};
    const auto threads =
        static_cast<int>(std::min<std::size_t>(count, static_cast<std::size_t>(threads_here())));
    const bool was_in_a_loop = std::exchange(is_in_a_loop, is_in_a_loop || threads > 1);
    std::vector<std::thread> others;
    for (int k = 1; k < threads; ++k) {
        try {
            others.emplace_back([&loop] {
                is_in_a_loop = true;
                loop.run();
            });
        } catch (const std::system_error&) {
            break;  // those that there are will do
        }
    }
    loop.run();
    for (std::thread& other : others) other.join();
    is_in_a_loop = was_in_a_loop;
    if (loop.fault) std::rethrow_exception(loop.fault);
}

int permitted_threads() {
    const std::lock_guard lock(limits_mutex);
    if (!limits.empty()) return *limits.begin();
    return std::max(k_fewest_threads, static_cast<int>(std::thread::hardware_concurrency()));
}

void with_threads(int threads, const std::function<void()>& body) {
    struct Scope {
        int before;
        ~Scope() { arena_threads = before; }
    };
    const Scope scope{std::exchange(arena_threads, threads)};
    body();
}

ThreadLimit::ThreadLimit(int threads) {
    if (threads <= 0) return;
    const std::lock_guard lock(limits_mutex);
    control_ = new std::multiset<int>::iterator(limits.insert(threads));
}

ThreadLimit::~ThreadLimit() {
    auto* const limit = static_cast<std::multiset<int>::iterator*>(control_);
    if (limit == nullptr) return;
    const std::lock_guard lock(limits_mutex);
    limits.erase(*limit);
    delete limit;
}

void work_in_background() {
    if (getpriority(PRIO_PROCESS, 0) < 10) setpriority(PRIO_PROCESS, 0, 10);
}

}  // namespace uw
