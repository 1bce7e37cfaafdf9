#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <system_error>
#include <thread>
#include <utility>

#include "core/base/error.h"

namespace uw {

/// Work that is done on a thread of its own, from construction on; by the constructor where the
/// system grants no thread. It is stopped as that of the thread that began it. The destructor waits
/// for it.
class BackgroundTask {
  public:
    explicit BackgroundTask(std::function<void()> work) : work_(std::move(work)) {
        try {
            thread_ = std::thread([this, stop = StopScope::of_this_thread()] {
                const StopScope scope(stop);
                run();
            });
        } catch (const std::system_error&) {
            run();
        }
    }
    ~BackgroundTask() {
        if (thread_.joinable()) thread_.join();
    }
    BackgroundTask(const BackgroundTask&) = delete;
    BackgroundTask& operator=(const BackgroundTask&) = delete;
    BackgroundTask(BackgroundTask&&) = delete;
    BackgroundTask& operator=(BackgroundTask&&) = delete;

    /// Whether finish() would not wait.
    bool is_done() const { return is_done_; }
    /// Waits for the work, and throws what it threw. To be called once.
    void finish() {
        if (thread_.joinable()) thread_.join();
        if (error_) std::rethrow_exception(error_);
    }

  private:
    void run() {
        try {
            work_();
        } catch (...) {
            error_ = std::current_exception();
        }
        is_done_ = true;
    }

    std::function<void()> work_;
    std::exception_ptr error_;
    std::atomic<bool> is_done_{false};
    std::thread thread_;  // last: it uses the others
};

}  // namespace uw
