#include "core/base/error.h"

#include <utility>

namespace uw {

namespace {

// It belongs to the thread, since TBB and the callbacks of other libraries pass no argument on to
// what asks.
thread_local const std::atomic<bool>* stop_of_thread = nullptr;

}  // namespace

StopScope::StopScope(const std::atomic<bool>* stop)
    : previous_(std::exchange(stop_of_thread, stop)) {}

StopScope::~StopScope() {
    stop_of_thread = previous_;
}

const std::atomic<bool>* StopScope::of_this_thread() {
    return stop_of_thread;
}

void throw_if_stopped() {
    if (stop_of_thread != nullptr && stop_of_thread->load(std::memory_order_relaxed))
        throw Interrupted();
}

}  // namespace uw
