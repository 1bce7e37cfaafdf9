#pragma once

#include <atomic>

#include "core/base/error.h"
#include "tests/support/full_disk.h"

namespace uw::test {

/// Runs `work`, which is to stop once a file would grow beyond `bytes`. It is the write itself that
/// asks for it, by a signal to its own thread: what is written from then on does not depend on any
/// clock.
template <typename Work>
void stopped_at_size(rlim_t bytes, const Work& work) {
    static std::atomic<bool> stop;
    stop = false;
    const FileSizeLimit limit(bytes, [](int) { stop = true; });
    const StopScope scope(stop);
    work();
}

}  // namespace uw::test
