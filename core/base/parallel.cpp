#include "core/base/parallel.h"

#include <sys/resource.h>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>

#include "core/base/error.h"

namespace uw {

namespace {

// A tenth of the scheduler's weight at the usual niceness.
constexpr int k_background_niceness = 10;

// On Linux niceness belongs to a thread, and 0 is the calling one. A thread that is nicer already
// stays so; failures do not matter.
void yield_to_others() {
    if (getpriority(PRIO_PROCESS, 0) < k_background_niceness)
        setpriority(PRIO_PROCESS, 0, k_background_niceness);
}

// Is called by each thread of the pool as it begins to work for the thread that made this.
class PoolObserver final : public tbb::task_scheduler_observer {
  public:
    PoolObserver() { observe(true); }
    ~PoolObserver() override { observe(false); }
    PoolObserver(const PoolObserver&) = delete;
    PoolObserver& operator=(const PoolObserver&) = delete;
    PoolObserver(PoolObserver&&) = delete;
    PoolObserver& operator=(PoolObserver&&) = delete;

    void on_scheduler_entry(bool is_worker) override {
        if (is_worker) yield_to_others();
    }
};

}  // namespace

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
    // Applies the calling thread's floating-point settings. Otherwise they would be those that it
    // had when it first used the pool: inside Embree, which flushes denormal numbers to 0
    // meanwhile.
    using Context = tbb::task_group_context;
    Context context(Context::bound, Context::default_traits | Context::fp_settings);
    const std::atomic<bool>* const stop = StopScope::of_this_thread();
    const auto step = [&](std::size_t i) {
        const StopScope scope(stop);
        throw_if_stopped();
        body(i);
    };
    tbb::parallel_for(std::size_t{0}, count, step, context);
}

int permitted_threads() {
    return static_cast<int>(
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void with_threads(int threads, const std::function<void()>& body) {
    tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
    arena.execute(body);
}

ThreadLimit::ThreadLimit(int threads) {
    if (threads > 0)
        control_ = new tbb::global_control(tbb::global_control::max_allowed_parallelism,
                                           static_cast<std::size_t>(threads));
}

ThreadLimit::~ThreadLimit() {
    delete static_cast<tbb::global_control*>(control_);
}

void work_in_background() {
    // Each thread has its own, since TBB shows an observer who joins in the loops of the thread
    // that made it.
    thread_local const PoolObserver observer;
    yield_to_others();
}

}  // namespace uw
