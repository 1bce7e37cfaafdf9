#pragma once

#include <sys/resource.h>

#include <csignal>

namespace uw::test {

/// Runs `work` while every write beyond `bytes` into a file fails, as on a full disk.
template <typename Work>
void limited(rlim_t bytes, const Work& work) {
    struct Restore {
        rlimit limit{};
        void (*handler)(int) = std::signal(SIGXFSZ, SIG_IGN);
        Restore() { ::getrlimit(RLIMIT_FSIZE, &limit); }
        ~Restore() {
            ::setrlimit(RLIMIT_FSIZE, &limit);
            std::signal(SIGXFSZ, handler);
        }
    } const restore;
    const rlimit full{bytes, restore.limit.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &full);
    work();
}

}  // namespace uw::test
