#include "edit/session/event_log.h"

#include <chrono>
#include <utility>

namespace uw {

namespace {

// Every event can be fetched again as part of the state: a window that falls further behind than
// this misses nothing that lasts.
constexpr std::size_t k_most_events = 256;

}  // namespace

void EventLog::publish(std::string name, std::string data) {
    const std::lock_guard lock(mutex_);
    events_.push_back({++last_, std::move(name), std::move(data)});
    if (events_.size() > k_most_events) events_.pop_front();
    changed_.notify_all();
}

std::uint64_t EventLog::last() const {
    const std::lock_guard lock(mutex_);
    return last_;
}

std::vector<Event> EventLog::wait(std::uint64_t after, double seconds) const {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::duration<double>(seconds),
                      [&] { return is_closed_ || last_ > after; });
    std::vector<Event> found;
    if (is_closed_) return found;
    for (const Event& event : events_)
        if (event.number > after) found.push_back(event);
    return found;
}

void EventLog::close() {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    changed_.notify_all();
}

bool EventLog::is_closed() const {
    const std::lock_guard lock(mutex_);
    return is_closed_;
}

}  // namespace uw
