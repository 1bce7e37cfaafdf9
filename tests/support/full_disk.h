#pragma once

#include <sys/resource.h>

#include <csignal>

namespace uw::test {

/// As long as it lives, every write beyond `bytes` into a file fails, and calls `on_excess` on the
/// thread that writes.
class FileSizeLimit {
  public:
    FileSizeLimit(rlim_t bytes, void (*on_excess)(int))
        : handler_(std::signal(SIGXFSZ, on_excess)) {
        ::getrlimit(RLIMIT_FSIZE, &limit_);
        const rlimit full{bytes, limit_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &full);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &limit_);
        std::signal(SIGXFSZ, handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;
    FileSizeLimit(FileSizeLimit&&) = delete;
    FileSizeLimit& operator=(FileSizeLimit&&) = delete;

  private:
    rlimit limit_{};
    void (*handler_)(int);
};

/// Runs `work` while every write beyond `bytes` into a file fails, as on a full disk.
template <typename Work>
void limited(rlim_t bytes, const Work& work) {
    const FileSizeLimit limit(bytes, SIG_IGN);
    work();
}

}  // namespace uw::test
