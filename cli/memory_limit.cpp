#include "cli/memory_limit.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdint>

#include "core/base/available_memory.h"

namespace uw {

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
