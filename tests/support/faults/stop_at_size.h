#pragma once

#include <sys/resource.h>

#include <atomic>
#include <csignal>

#include "core/base/stop.h"

namespace uw::test {

/// Runs `work`, which is to stop once a file would grow beyond `bytes`. It is the write itself that
/// asks for it, by a signal to its own thread: what is written from then on does not depend on any
/// clock.
template <typename Work>
void stopped_at_size(rlim_t bytes, const Work& work) {
    static std::atomic<bool> stop;
    stop = false;
    struct Restore {
        rlimit limit{};
        void (*handler)(int) = std::signal(SIGXFSZ, [](int) { stop = true; });
        Restore() { ::getrlimit(RLIMIT_FSIZE, &limit); }
        ~Restore() {
            ::setrlimit(RLIMIT_FSIZE, &limit);
            std::signal(SIGXFSZ, handler);
        }
    } const restore;
    const rlimit full{bytes, restore.limit.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &full);
    const StopScope scope(stop);
    work();
}

}  // namespace uw::test
