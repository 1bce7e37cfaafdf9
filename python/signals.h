#pragma once

#include <functional>

#include "python/watched_task.h"

namespace uw {

/// Throws what the handlers of signals raised, KeyboardInterrupt for Ctrl-C. Takes the
/// interpreter's lock meanwhile.
void check_signals();

/// Runs `work` such that signals end it, and throws what their handlers raised, else what the work
/// threw. Gives the interpreter's lock away meanwhile, which the caller holds.
void run_interruptible(WatchedTask& task, const std::function<void()>& work);

}  // namespace uw
