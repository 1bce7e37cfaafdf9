#pragma once

#include <atomic>

namespace uw {

/// As long as it lives, what its thread does, and what it runs by parallel_for, ends with
/// Interrupted once `stop` is set: at the next throw_if_stopped(). One within another replaces it
/// for the time being.
class StopScope {
  public:
    explicit StopScope(const std::atomic<bool>& stop) : StopScope(&stop) {}
    /// Null: nothing stops the work.
    explicit StopScope(const std::atomic<bool>* stop);
    ~StopScope();
    StopScope(const StopScope&) = delete;
    StopScope& operator=(const StopScope&) = delete;
    StopScope(StopScope&&) = delete;
    StopScope& operator=(StopScope&&) = delete;

    /// That of the calling thread; null if there is none.
    static const std::atomic<bool>* of_this_thread();

  private:
    const std::atomic<bool>* previous_;
};

/// Throws Interrupted where the calling thread's work is to stop. It costs some nanoseconds: work
/// is to ask before each ray, path or step that it takes, and never to do more than some
/// milliseconds' worth without asking. Not to be called from within Embree.
void throw_if_stopped();

}  // namespace uw
