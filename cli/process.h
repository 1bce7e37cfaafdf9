#pragma once

#include <atomic>

namespace uw {

/// Lets Ctrl-C (SIGINT, SIGTERM) end the program at once with exit code 130 and a one-line message,
/// which is safe as long as nothing is being written.
void install_stop_signal();

/// From now on Ctrl-C requests an orderly stop, which sets stop_flag(); a second one ends the
/// program at once.
void begin_orderly_stop();

/// Whether an orderly stop has been requested: for a StopScope around the work.
const std::atomic<bool>& stop_flag();

/// For a program that has nothing to do until it is stopped, instead of the above: Ctrl-C waits for
/// wait_for_stop_signal(). To be called before any thread is started.
void hold_stop_signal();
void wait_for_stop_signal();

}  // namespace uw
