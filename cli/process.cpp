#include "cli/process.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstring>

#include "cli/command.h"
#include "core/base/available_memory.h"

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

namespace {

// What the kernel needs for the process beside its data: page tables, files that are being written.
constexpr double k_share_of_kernel = 1.0 / 16;

rlimit current_limit() {
    rlimit limit{RLIM_INFINITY, RLIM_INFINITY};
    ::getrlimit(RLIMIT_DATA, &limit);
    return limit;
}

void set_soft_limit(rlim_t bytes) {
    rlimit limit = current_limit();
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_DATA, &limit);
}

rlim_t limit_before = RLIM_INFINITY, limit_of_ours = RLIM_INFINITY;

}  // namespace

void limit_memory() {
    limit_before = limit_of_ours = current_limit().rlim_cur;
    const auto available = static_cast<double>(available_memory_bytes());
    const double most = static_cast<double>(data_bytes()) + (1 - k_share_of_kernel) * available;
    // More than that is no limit.
    constexpr double k_largest = 0x1p62;
    if (!(most < k_largest)) return;
    limit_of_ours = std::min(limit_before, static_cast<rlim_t>(most));
    set_soft_limit(limit_of_ours);
}

MemoryLimitLifted::MemoryLimitLifted() {
    set_soft_limit(limit_before);
}

MemoryLimitLifted::~MemoryLimitLifted() {
    set_soft_limit(limit_of_ours);
}

}  // namespace uw
