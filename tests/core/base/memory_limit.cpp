// ctest labels: unit
// The limit that a process sets itself (limit_memory).
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <cstdlib>
#include <new>

#include "core/base/available_memory.h"

namespace uw {
namespace {

rlim_t data_limit() {
    rlimit limit{};
    ::getrlimit(RLIMIT_DATA, &limit);
    return limit.rlim_cur;
}

/// Whether memory that nobody uses can be had: where nothing limits the process, Linux grants it.
bool can_have(std::uint64_t bytes) {
    constexpr int k_writable = PROT_READ | PROT_WRITE;
    constexpr int k_flags = MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE;
    void* const memory = ::mmap(nullptr, bytes, k_writable, k_flags, -1, 0);
    if (memory == MAP_FAILED) return false;
    ::munmap(memory, bytes);
    return true;
}

// Each in a process of its own, which is limited.
TEST(MemoryLimit, GrantsWhatIsAvailableAndNoMore) {
    EXPECT_EXIT(
        {
            const std::uint64_t available = available_memory_bytes();
            const bool before = can_have(2 * available);
            limit_memory();
            const bool half = can_have(available / 2);
            const bool twice = can_have(2 * available);
            std::_Exit(before && half && !twice ? 7 : 1);
        },
        testing::ExitedWithCode(7), "^$");
}

TEST(MemoryLimit, EndsAnAllocation) {
    EXPECT_EXIT(
        {
            limit_memory();
            // Half of the memory is left.
            const std::uint64_t all = available_memory_bytes();
            try {
                for (int n = 0; n < 4; ++n) static_cast<void>(::operator new(all / 2));
            } catch (const std::bad_alloc&) {
                std::_Exit(7);
            }
            std::_Exit(1);
        },
        testing::ExitedWithCode(7), "^$");
}

// What is refused beforehand is refused by the same measure.
TEST(MemoryLimit, IsAvailableMemory) {
    EXPECT_EXIT(
        {
            rlimit limit{};
            ::getrlimit(RLIMIT_DATA, &limit);
            constexpr rlim_t k_more = 100'000'000;
            limit.rlim_cur = data_bytes() + k_more;
            ::setrlimit(RLIMIT_DATA, &limit);
            const std::uint64_t available = available_memory_bytes();
            std::_Exit(available <= k_more && available > k_more / 2 ? 7 : 1);
        },
        testing::ExitedWithCode(7), "^$");
}

// Whatever else ran when it was set: here it begins at next to nothing, and is then that of now.
TEST(MemoryLimit, IsRenewed) {
    EXPECT_EXIT(
        {
            renew_memory_limit();
            const bool is_unset = data_limit() == RLIM_INFINITY;
            limit_memory();
            rlimit limit{};
            ::getrlimit(RLIMIT_DATA, &limit);
            constexpr rlim_t k_next_to_nothing = 1'000'000;
            limit.rlim_cur = data_bytes() + k_next_to_nothing;
            ::setrlimit(RLIMIT_DATA, &limit);
            const std::uint64_t before = available_memory_bytes();
            renew_memory_limit();
            const bool is_more = available_memory_bytes() > 10 * k_next_to_nothing;
            std::_Exit(is_unset && before <= k_next_to_nothing && is_more ? 7 : 1);
        },
        testing::ExitedWithCode(7), "^$");
}

TEST(MemoryLimit, IsNotInheritedWhileItIsLifted) {
    EXPECT_EXIT(
        {
            const rlim_t before = data_limit();
            limit_memory();
            const rlim_t limited = data_limit();
            bool is_lifted = false;
            {
                const MemoryLimitLifted lifted;
                is_lifted = data_limit() == before;
            }
            std::_Exit(limited < before && is_lifted && data_limit() == limited ? 7 : 1);
        },
        testing::ExitedWithCode(7), "^$");
}

}  // namespace
}  // namespace uw
