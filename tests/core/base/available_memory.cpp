// ctest labels: unit
#include "core/base/available_memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temp_dir.h"

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

/// The files of a machine with 8 GB free.
class FreeMemory : public testing::Test {
  protected:
    FreeMemory() { write("proc/meminfo", "MemAvailable: 7812500 kB\nSwapFree: 0 kB\n"); }
    void write(const std::string& name, const std::string& text) const {
        const std::filesystem::path file = folder_ / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file) << text;
    }
    std::uint64_t available() const { return available_memory_bytes(folder_.path()); }

    static constexpr std::uint64_t k_all = 8'000'000'000;
    test::TempDir folder_;
};

TEST_F(FreeMemory, IsTheMachinesWhereNothingLimitsIt) {
    EXPECT_EQ(available(), k_all);
    write("proc/self/cgroup", "0::/user.slice\n");
    write("sys/fs/cgroup/user.slice/memory.max", "max\n");
    EXPECT_EQ(available(), k_all);
}

TEST_F(FreeMemory, IsWhatTheControlGroupLeaves) {
    write("proc/self/cgroup", "0::/user.slice/job\n");
    write("sys/fs/cgroup/user.slice/job/memory.max", "2000000000\n");
    write("sys/fs/cgroup/user.slice/job/memory.current", "900000000\n");
    EXPECT_EQ(available(), 1'100'000'000U);
    // Files that are read and not written are let go where memory is needed.
    write("sys/fs/cgroup/user.slice/job/memory.stat",
          "anon 300000000\ninactive_file 500000000\nactive_file 100000000\n");
    EXPECT_EQ(available(), 1'700'000'000U);
    // The limit of a group above may leave less, and more may be used than a limit set since.
    write("sys/fs/cgroup/user.slice/memory.max", "1500000000\n");
    EXPECT_EQ(available(), 1'500'000'000U);
    write("sys/fs/cgroup/user.slice/memory.current", "1600000000\n");
    EXPECT_EQ(available(), 0U);
}

TEST_F(FreeMemory, IsWhatAGroupOfTheFirstVersionLeaves) {
    write("proc/self/cgroup", "4:cpu,cpuacct:/job\n3:memory:/job\n");
    write("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
    write("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "2000000000\n");
    write("sys/fs/cgroup/memory/job/memory.usage_in_bytes", "500000000\n");
    write("sys/fs/cgroup/memory/job/memory.stat",
          "inactive_file 1\ntotal_inactive_file 60000000\ntotal_active_file 40000000\n");
    EXPECT_EQ(available(), 1'600'000'000U);
}

TEST_F(FreeMemory, IsThatOfTheContainerInsideOfIt) {
    write("proc/self/cgroup", "0::/\n");
    write("sys/fs/cgroup/memory.max", "2000000000\n");
    write("sys/fs/cgroup/memory.current", "200000000\n");
    EXPECT_EQ(available(), 1'800'000'000U);
}

}  // namespace
}  // namespace uw
