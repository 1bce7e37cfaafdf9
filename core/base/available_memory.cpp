#include "core/base/available_memory.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <limits>
#include <mutex>
#include <sstream>
#include <string>
#include <thread>
#include <utility>

#include "core/base/error.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t k_unknown = std::numeric_limits<std::uint64_t>::max();

std::uint64_t less(std::uint64_t all, std::uint64_t used) {
    return all > used ? all - used : 0;
}

// The value of `key` in a file of lines as "MemAvailable:   21333764 kB", [bytes].
std::uint64_t bytes_of(std::string_view key, const fs::path& file) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with(key)) continue;
        std::istringstream value(line.substr(key.size()));
        std::uint64_t kilobytes = 0;
        return value >> kilobytes ? kilobytes * 1024 : k_unknown;
    }
    return k_unknown;
}

/// How much memory there is, and how much of it is free [bytes].
struct MemoryLimit {
    std::uint64_t all = k_unknown, left = k_unknown;

    void limit_to(const MemoryLimit& other) {
        all = std::min(all, other.all);
        left = std::min(left, other.left);
    }
};

MemoryLimit of_the_machine(const fs::path& root) {
    const fs::path file = root / "proc/meminfo";
    const auto with_swap = [&](std::string_view memory, std::string_view swap) {
        const std::uint64_t bytes = bytes_of(memory, file), more = bytes_of(swap, file);
        return bytes == k_unknown || more == k_unknown ? bytes : bytes + more;
    };
    return {with_swap("MemTotal:", "SwapTotal:"), with_swap("MemAvailable:", "SwapFree:")};
}

/// The number in a file; `k_unknown` if there is none, as where it says "max".
std::uint64_t number_in(const fs::path& file) {
    std::ifstream in(file);
    std::uint64_t number = 0;
    return in >> number ? number : k_unknown;
}

/// The names of the files of a version of control groups.
struct GroupFiles {
    const char *limit, *usage;
    std::array<std::string_view, 2> cached;  // entries of memory.stat
};
constexpr GroupFiles k_version_1{
    "memory.limit_in_bytes", "memory.usage_in_bytes", {"total_inactive_file", "total_active_file"}};
constexpr GroupFiles k_version_2{"memory.max", "memory.current", {"inactive_file", "active_file"}};

MemoryLimit of_group(const fs::path& group, const GroupFiles& files) {
    const std::uint64_t limit = number_in(group / files.limit);
    if (limit == k_unknown) return {};
    const std::uint64_t used = number_in(group / files.usage);
    std::uint64_t cached = 0, value = 0;
    std::ifstream statistics(group / "memory.stat");
    for (std::string key; statistics >> key >> value;)
        if (std::ranges::find(files.cached, key) != files.cached.end()) cached += value;
    return {limit, less(limit, less(used == k_unknown ? 0 : used, cached))};
}

/// The memory that the process's control groups leave it: the one that /proc/self/cgroup names and
/// those above it, or, as inside a container, those that are mounted.
MemoryLimit of_groups(const fs::path& root) {
    const fs::path mounted = root / "sys/fs/cgroup";
    MemoryLimit limit = of_group(mounted, k_version_2);
    limit.limit_to(of_group(mounted / "memory", k_version_1));
    std::ifstream in(root / "proc/self/cgroup");
    for (std::string line; std::getline(in, line);) {
        // "0::/user.slice" of version 2, "6:memory:/user.slice" of version 1.
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const bool is_second = controllers.empty();
        if (!is_second && ("," + controllers + ",").find(",memory,") == std::string::npos) continue;
        fs::path name = fs::path(line.substr(second + 1)).relative_path();
        for (; !name.empty(); name = name.parent_path())
            limit.limit_to(is_second ? of_group(mounted / name, k_version_2)
                                     : of_group(mounted / "memory" / name, k_version_1));
    }
    return limit;
}

std::uint64_t left_of_address_space(const fs::path& root) {
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return k_unknown;
    const std::uint64_t pages = number_in(root / "proc/self/statm");
    const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGE_SIZE));
    return less(limit.rlim_cur, pages == k_unknown ? 0 : pages * page);
}

std::uint64_t left_of_data(const fs::path& root) {
    rlimit limit{};
    if (::getrlimit(RLIMIT_DATA, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return k_unknown;
    return less(limit.rlim_cur, data_bytes(root));
}

}  // namespace

std::uint64_t data_bytes(const fs::path& root) {
    const std::uint64_t data = bytes_of("VmData:", root / "proc/self/status");
    return data == k_unknown ? 0 : data;
}

FreeMemory read_free_memory(const fs::path& root) {
    MemoryLimit shared = of_the_machine(root);
    shared.limit_to(of_groups(root));
    return {shared.left, std::min(left_of_address_space(root), left_of_data(root)), shared.all};
}

std::uint64_t available_memory_bytes(const fs::path& root) {
    return read_free_memory(root).available();
}

namespace {

// It belongs to the thread, as what asks for memory may lie below the callback of a library.
thread_local const MemoryWait* wait_of_thread = nullptr;

void sleep_unless_stopped(double seconds) {
    throw_if_stopped();
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    throw_if_stopped();
}

}  // namespace

MemoryWaitScope::MemoryWaitScope(const MemoryWait& wait)
    : previous_(std::exchange(wait_of_thread, &wait)) {}

MemoryWaitScope::~MemoryWaitScope() {
    wait_of_thread = previous_;
}

const MemoryWait& MemoryWaitScope::of_this_thread() {
    static const MemoryWait by_itself;
    return wait_of_thread != nullptr ? *wait_of_thread : by_itself;
}

void require_memory(double bytes, std::string_view what, std::string_view hint) {
    const MemoryWait& wait = MemoryWaitScope::of_this_thread();
    const auto is_less = [&](std::uint64_t there) { return static_cast<double>(there) < bytes; };
    FreeMemory free = wait.read();
    if (!is_less(free.available())) return;
    // Our own limit may date from a moment of shortage.
    renew_memory_limit();
    free = wait.read();
    // The first pauses are too short to be noticed.
    constexpr double k_first_pause = 0.01, k_longest_pause = 0.25, k_silent = 1;
    double waited = 0, pause = k_first_pause;
    bool has_told = false;
    for (; is_less(free.available()); free = wait.read()) {
        const std::string line =
            fmt::format("{} {:.3g} GB of memory, but only {:.3g} GB are free; {}", what,
                        bytes * 1e-9, static_cast<double>(free.available()) * 1e-9, hint);
        if (is_less(free.most)) throw InputError(line);
        if (is_less(free.own) || !(waited < wait.seconds)) throw OutOfMemory(line);
        if (wait.tell && waited >= k_silent && !std::exchange(has_told, true)) wait.tell(line);
        (wait.sleep ? wait.sleep : sleep_unless_stopped)(pause);
        waited += pause;
        pause = std::min(2 * pause, k_longest_pause);
    }
}

namespace {

// The fraction that the kernel needs for the process beside its data: page tables, files that are
// being written.
constexpr double k_kernel_fraction = 1.0 / 16;

/// The limit of data that this process has set itself.
struct DataLimit {
    std::mutex mutex;
    bool is_set = false;
    int lifted = 0;  // number of living MemoryLimitLifted
    rlim_t before = RLIM_INFINITY, ours = RLIM_INFINITY;

    static rlimit current() {
        rlimit limit{RLIM_INFINITY, RLIM_INFINITY};
        ::getrlimit(RLIMIT_DATA, &limit);
        return limit;
    }
    static void set(rlim_t bytes) {
        rlimit limit = current();
        limit.rlim_cur = bytes;
        ::setrlimit(RLIMIT_DATA, &limit);
    }
    void renew() {
        const FreeMemory free = read_free_memory();
        const std::uint64_t left = std::min(free.shared, left_of_address_space("/"));
        const double most =
            static_cast<double>(data_bytes()) + (1 - k_kernel_fraction) * static_cast<double>(left);
        // More than that is no limit.
        constexpr double k_max_limit = 0x1p62;
        ours = most < k_max_limit ? std::min(before, static_cast<rlim_t>(most)) : before;
        if (lifted == 0) set(ours);
    }
};

DataLimit& data_limit() {
    static DataLimit limit;
    return limit;
}

}  // namespace

void limit_memory() {
    DataLimit& limit = data_limit();
    const std::lock_guard lock(limit.mutex);
    if (!std::exchange(limit.is_set, true)) limit.before = DataLimit::current().rlim_cur;
    limit.renew();
}

void renew_memory_limit() {
    DataLimit& limit = data_limit();
    const std::lock_guard lock(limit.mutex);
    if (limit.is_set) limit.renew();
}

MemoryLimitLifted::MemoryLimitLifted() {
    DataLimit& limit = data_limit();
    const std::lock_guard lock(limit.mutex);
    if (limit.lifted++ == 0 && limit.is_set) DataLimit::set(limit.before);
}

MemoryLimitLifted::~MemoryLimitLifted() {
    DataLimit& limit = data_limit();
    const std::lock_guard lock(limit.mutex);
    if (--limit.lifted == 0 && limit.is_set) DataLimit::set(limit.ours);
}

}  // namespace uw
