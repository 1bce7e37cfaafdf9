#include "cli/process.h"

#include <unistd.h>

#include <csignal>
#include <cstring>

#include "cli/command.h"

namespace uw {

namespace {

volatile std::sig_atomic_t g_orderly = 0;
std::atomic<bool> g_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // a signal handler sets it
volatile std::sig_atomic_t g_skip = 1;  // 0 on a terminal, where "^C" or a bar fills the line

sigset_t stop_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    return signals;
}

// Only async-signal-safe calls: write(2), _exit(2).
void on_signal(int signal) {
    if (g_orderly == 0) {
        const char* const text = "\nuwvdb: interrupted; nothing was written\n";
        const char* const line = text + g_skip;
        if (write(STDERR_FILENO, line, std::strlen(line)) < 0) _exit(k_exit_interrupted);
        _exit(k_exit_interrupted);
    }
    g_stop = true;
    std::signal(signal, SIG_DFL);
}

}  // namespace

void install_stop_signal() {
    g_skip = isatty(STDERR_FILENO) != 0 ? 0 : 1;
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
}

void begin_orderly_stop() {
    g_orderly = 1;
}

const std::atomic<bool>& stop_flag() {
    return g_stop;
}

void hold_stop_signal() {
    const sigset_t signals = stop_signals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

void wait_for_stop_signal() {
    const sigset_t signals = stop_signals();
    int received = 0;
    while (sigwait(&signals, &received) != 0) {
    }
}

}  // namespace uw
