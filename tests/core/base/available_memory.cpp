// ctest labels: unit
#include "core/base/available_memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace uw {
namespace {

TEST(AvailableMemory, IsSomeAndNoMoreThanMachineAndContainerHave) {
    const std::uint64_t available = available_memory_bytes();
    EXPECT_GT(available, std::uint64_t{1} << 20);  // this test runs
    const auto pages = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES));
    std::uint64_t swap = 0, value = 0;
    std::ifstream meminfo("/proc/meminfo");
    for (std::string key, unit; meminfo >> key >> value; std::getline(meminfo, unit))
        if (key == "SwapTotal:") swap = value * 1024;
    EXPECT_LE(available, pages * static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE)) + swap);
    if (std::uint64_t limit = 0; std::ifstream("/sys/fs/cgroup/memory.max") >> limit) {
        EXPECT_LE(available, limit);
    }
}

}  // namespace
}  // namespace uw
