#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

namespace uw {

/// Something that windows are to be told of.
struct Event {
    std::uint64_t number = 0;  // from 1
    std::string name;
    std::string data;  // JSON, one line
};

/// The latest events, for any number of windows to follow at their own pace. Thread safe.
class EventLog {
  public:
    void publish(std::string name, std::string data);

    /// The number of the last event; 0 before the first.
    std::uint64_t last() const;
    /// The events after number `after` that are still kept, in their order; waits up to `seconds`
    /// for one. Empty if none has come, or the log is closed.
    std::vector<Event> wait(std::uint64_t after, double seconds) const;

    /// Ends all waiting.
    void close();
    bool is_closed() const;

  private:
    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    std::deque<Event> events_;
    std::uint64_t last_ = 0;
    bool is_closed_ = false;
};

}  // namespace uw
