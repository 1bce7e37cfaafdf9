#include "cli/console.h"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "core/base/error.h"

namespace uw {

void prepare_streams() {
    // open() returns the lowest free number: one after the other, those that were closed.
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(stream, F_GETFD) < 0 && ::open("/dev/null", O_RDWR) < 0) return;
    std::signal(SIGXFSZ, SIG_IGN);
}

void print_message(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

void print_output(std::string_view text) {
    const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
    if (std::fflush(stdout) != 0 || !written)
        throw IoError("standard output: cannot write; is the disk full?");
}

}  // namespace uw
