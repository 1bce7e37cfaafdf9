#pragma once

#include <cstddef>
#include <functional>

namespace uw {

/// Runs `body(i)` for i in [0, count) on all permitted threads. Iterations must be independent; the
/// first exception thrown by a body stops the rest and is rethrown. All run with the calling
/// thread's floating-point settings, and stop when it is to stop (StopScope).
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body);

/// How many threads parallel_for may use now.
int permitted_threads();

/// Runs `body`, within which parallel_for (and the libraries that share its pool) uses at most this
/// many threads, the calling one included, whatever the rest of the program does; 0: all cores.
void with_threads(int threads, const std::function<void()>& body);

/// Limits how many threads parallel_for (and the libraries that share its pool) may use for as
/// long as the object lives; 0 means all cores.
class ThreadLimit {
  public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;
    ThreadLimit(ThreadLimit&&) = delete;
    ThreadLimit& operator=(ThreadLimit&&) = delete;

  private:
    void* control_ = nullptr;
};

/// Lowers the priority of the calling thread from now on, and of each thread of parallel_for's pool
/// from when it first works for this one, until they end: for work in the background.
void work_in_background();

}  // namespace uw
