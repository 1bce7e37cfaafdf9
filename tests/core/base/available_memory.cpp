// ctest labels: unit
#include "core/base/available_memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/base/random.h"
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
class FreeMemoryFiles : public testing::Test {
  protected:
    FreeMemoryFiles() { write("proc/meminfo", "MemAvailable: 7812500 kB\nSwapFree: 0 kB\n"); }
    void write(const std::string& name, const std::string& text) const {
        const std::filesystem::path file = folder_ / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file) << text;
    }
    std::uint64_t available() const { return available_memory_bytes(folder_.path()); }

    static constexpr std::uint64_t k_all = 8'000'000'000;
    test::TempDir folder_;
};

TEST_F(FreeMemoryFiles, IsTheMachinesWhereNothingLimitsIt) {
    EXPECT_EQ(available(), k_all);
    write("proc/self/cgroup", "0::/user.slice\n");
    write("sys/fs/cgroup/user.slice/memory.max", "max\n");
    EXPECT_EQ(available(), k_all);
}

TEST_F(FreeMemoryFiles, IsWhatTheControlGroupLeaves) {
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

TEST_F(FreeMemoryFiles, IsWhatAGroupOfTheFirstVersionLeaves) {
    write("proc/self/cgroup", "4:cpu,cpuacct:/job\n3:memory:/job\n");
    write("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
    write("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "2000000000\n");
    write("sys/fs/cgroup/memory/job/memory.usage_in_bytes", "500000000\n");
    write("sys/fs/cgroup/memory/job/memory.stat",
          "inactive_file 1\ntotal_inactive_file 60000000\ntotal_active_file 40000000\n");
    EXPECT_EQ(available(), 1'600'000'000U);
}

TEST_F(FreeMemoryFiles, IsThatOfTheContainerInsideOfIt) {
    write("proc/self/cgroup", "0::/\n");
    write("sys/fs/cgroup/memory.max", "2000000000\n");
    write("sys/fs/cgroup/memory.current", "200000000\n");
    EXPECT_EQ(available(), 1'800'000'000U);
}

TEST_F(FreeMemoryFiles, IsAtMostWhatThereIs) {
    write("proc/meminfo",
          "MemTotal: 15625000 kB\nMemAvailable: 7812500 kB\nSwapTotal: 1000 kB\nSwapFree: 0 kB\n");
    EXPECT_EQ(read_free_memory(folder_.path()).most, 2 * k_all + 1'024'000);
    EXPECT_EQ(read_free_memory(folder_.path()).shared, k_all);
    write("proc/self/cgroup", "0::/job\n");
    write("sys/fs/cgroup/job/memory.max", "2000000000\n");
    write("sys/fs/cgroup/job/memory.current", "900000000\n");
    EXPECT_EQ(read_free_memory(folder_.path()).most, 2'000'000'000U);
    EXPECT_EQ(read_free_memory(folder_.path()).shared, 1'100'000'000U);
}

/// What require_memory does while memory is as `readings` say, the last of them for ever.
class Required {
  public:
    explicit Required(std::vector<FreeMemory> readings) : readings_(std::move(readings)) {
        wait_.read = [this] { return readings_[std::min(read_++, readings_.size() - 1)]; };
        wait_.sleep = [this](double seconds) { slept_ += seconds; };
        wait_.tell = [this](const std::string& line) { told_.push_back(line); };
    }

    /// Its message; empty: there was enough.
    std::string of(double bytes, double seconds) {
        wait_.seconds = seconds;
        const MemoryWaitScope scope(wait_);
        try {
            require_memory(bytes, "this needs", "ask for less");
            return "";
        } catch (const OutOfMemory& error) {
            is_input_ = false;
            return error.what();
        } catch (const InputError& error) {
            is_input_ = true;
            return error.what();
        }
    }
    bool is_input() const { return is_input_; }
    double slept() const { return slept_; }
    const std::vector<std::string>& told() const { return told_; }

  private:
    std::vector<FreeMemory> readings_;
    MemoryWait wait_;
    std::size_t read_ = 0;
    double slept_ = 0;
    bool is_input_ = false;
    std::vector<std::string> told_;
};

constexpr std::uint64_t k_any = std::numeric_limits<std::uint64_t>::max();

TEST(RequiredMemory, IsThere) {
    Required required({{2'000'000'000, k_any, k_any}});
    EXPECT_EQ(required.of(1e9, 60), "");
    EXPECT_EQ(required.slept(), 0);
}

// Free memory that goes up and down: the number that is printed is the one that was compared, so
// that the message never contradicts itself.
TEST(RequiredMemory, PrintsWhatItComparedWith) {
    PathRandom random(PathRandom::seed_of(7, 1), 0);
    int refused = 0;
    for (int n = 0; n < 200; ++n) {
        std::vector<FreeMemory> readings;
        for (int k = 0; k < 40; ++k)
            readings.push_back({static_cast<std::uint64_t>(2e9 * random.next()), k_any, k_any});
        const double bytes = 1e9 * (1 + random.next());
        Required required(readings);
        const std::string line = required.of(bytes, random.next());
        if (line.empty()) continue;
        ++refused;
        double needed = 0, free = 0;
        ASSERT_EQ(std::sscanf(line.c_str(),
                              "this needs %lg GB of memory, but only %lg GB are free; ask for less",
                              &needed, &free),
                  2)
            << line;
        EXPECT_NEAR(needed, bytes * 1e-9, 0.005 * needed);  // three digits
        EXPECT_LE(free, needed) << line;
    }
    EXPECT_GT(refused, 5);
}

TEST(RequiredMemory, IsWaitedForAndToldOfOnce) {
    const FreeMemory little{1'000'000, k_any, 8'000'000'000}, enough{2'000'000'000, k_any, k_any};
    std::vector<FreeMemory> readings(30, little);
    readings.push_back(enough);
    Required required(readings);
    EXPECT_EQ(required.of(1e9, 60), "");
    EXPECT_GT(required.slept(), 1);
    EXPECT_LT(required.slept(), 10);
    ASSERT_EQ(required.told().size(), 1U);
    EXPECT_NE(required.told()[0].find("this needs 1 GB of memory, but only 0.001 GB are free"),
              std::string::npos);
}

TEST(RequiredMemory, IsNotWaitedForForEver) {
    Required required({{1'000'000, k_any, 8'000'000'000}});
    EXPECT_NE(required.of(1e9, 60), "");
    EXPECT_FALSE(required.is_input());
    EXPECT_GE(required.slept(), 60);
    EXPECT_LT(required.slept(), 61);
}

// No waiting helps against what the machine has not, or what this process may not have.
TEST(RequiredMemory, IsRefusedAtOnceWhereItCannotBe) {
    Required more_than_all({{1'000'000, k_any, 8'000'000'000}});
    EXPECT_NE(more_than_all.of(9e9, 60), "");
    EXPECT_TRUE(more_than_all.is_input());
    EXPECT_EQ(more_than_all.slept(), 0);
    Required limited({{k_any, 1'000'000, k_any}});
    EXPECT_NE(limited.of(1e9, 60), "");
    EXPECT_FALSE(limited.is_input());
    EXPECT_EQ(limited.slept(), 0);
}

}  // namespace
}  // namespace uw
