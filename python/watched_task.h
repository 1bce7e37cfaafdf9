#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <vector>

#include "core/base/progress.h"

namespace uw {

/// Work on a thread of its own while the thread that wants it looks after other things: signals,
/// and what is told of the progress.
class WatchedTask {
  public:
    struct News {
        Stage stage{};
        double fraction = 0;
    };
    /// Called on the calling thread every k_interval and at the end, with what was told since. What
    /// it throws ends the work.
    using Watch = std::function<void(const std::vector<News>& news)>;

    /// Runs `work` to its end and returns, or throws what `watch` threw, else what `work` threw.
    void run(const std::function<void()>& work, const Watch& watch);

    /// For the work, from any of its threads: how far a stage is.
    void tell(Stage stage, double fraction);

  private:
    std::vector<News> take_news();

    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<News> news_;  // the last of each stage, and each one's begin
    bool is_done_ = false;
    std::atomic<bool> is_cancelled_ = false;
};

/// Throws what the handlers of signals raised, KeyboardInterrupt for Ctrl-C. Takes the
/// interpreter's lock meanwhile.
void check_signals();

/// Runs `work` such that signals end it, and throws what their handlers raised, else what the work
/// threw. Gives the interpreter's lock away meanwhile, which the caller holds.
void run_interruptible(WatchedTask& task, const std::function<void()>& work);

}  // namespace uw
