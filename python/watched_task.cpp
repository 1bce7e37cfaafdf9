#include "python/watched_task.h"

#include <pybind11/pybind11.h>

#include <chrono>
#include <exception>
#include <thread>
#include <utility>

#include "core/base/error.h"

namespace uw {

namespace {

// A person who presses Ctrl-C does not notice it, and neither does the work.
constexpr std::chrono::milliseconds k_interval{20};

}  // namespace

std::vector<WatchedTask::News> WatchedTask::take_news() {
    return std::exchange(news_, {});
}

void WatchedTask::tell(Stage stage, double fraction) {
    const std::lock_guard lock(mutex_);
    const bool goes_on =
        !news_.empty() && news_.back().stage == stage && fraction > 0 && news_.back().fraction > 0;
    if (goes_on)
        news_.back().fraction = fraction;
    else
        news_.push_back({stage, fraction});
}

void WatchedTask::run(const std::function<void()>& work, const Watch& watch) {
    is_done_ = false;
    is_cancelled_ = false;
    news_.clear();
    std::exception_ptr fault, stop;
    std::thread worker([&] {
        const StopScope scope(is_cancelled_);
        try {
            work();
        } catch (...) {
            fault = std::current_exception();
        }
        const std::lock_guard lock(mutex_);
        is_done_ = true;
        changed_.notify_all();
    });
    const auto look = [&](const std::vector<News>& news) {
        if (stop) return;
        try {
            watch(news);
        } catch (...) {
            stop = std::current_exception();
            is_cancelled_ = true;
        }
    };
    std::unique_lock lock(mutex_);
    while (!changed_.wait_for(lock, k_interval, [this] { return is_done_; })) {
        const std::vector<News> news = take_news();
        lock.unlock();
        look(news);
        lock.lock();
    }
    lock.unlock();
    worker.join();
    if (!fault) look(take_news());
    if (stop) std::rethrow_exception(stop);
    if (fault) std::rethrow_exception(fault);
}

namespace py = pybind11;

void check_signals() {
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void run_interruptible(WatchedTask& task, const std::function<void()>& work) {
    const py::gil_scoped_release release;
    task.run(work, [](const std::vector<WatchedTask::News>& /*news*/) { check_signals(); });
}

}  // namespace uw
