#include "core/base/available_memory.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

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

std::uint64_t available_on_the_machine(const fs::path& root) {
    const fs::path file = root / "proc/meminfo";
    const std::uint64_t available = bytes_of("MemAvailable:", file);
    const std::uint64_t swap = bytes_of("SwapFree:", file);
    return available == k_unknown || swap == k_unknown ? available : available + swap;
}

/// The number in a file; `k_unknown` if there is none, as where it says "max".
std::uint64_t number_in(const fs::path& file) {
    std::ifstream in(file);
    std::uint64_t number = 0;
    return in >> number ? number : k_unknown;
}

/// What the files of a version of control groups are called.
struct GroupFiles {
    const char *limit, *usage;
    std::array<std::string_view, 2> cached;  // entries of memory.stat
};
constexpr GroupFiles k_version_1{
    "memory.limit_in_bytes", "memory.usage_in_bytes", {"total_inactive_file", "total_active_file"}};
constexpr GroupFiles k_version_2{"memory.max", "memory.current", {"inactive_file", "active_file"}};

std::uint64_t left_in_group(const fs::path& group, const GroupFiles& files) {
    const std::uint64_t limit = number_in(group / files.limit);
    if (limit == k_unknown) return k_unknown;
    const std::uint64_t used = number_in(group / files.usage);
    std::uint64_t cached = 0, value = 0;
    std::ifstream statistics(group / "memory.stat");
    for (std::string key; statistics >> key >> value;)
        if (std::ranges::find(files.cached, key) != files.cached.end()) cached += value;
    return less(limit, less(used == k_unknown ? 0 : used, cached));
}

/// What its control groups leave the process: the one that /proc/self/cgroup names and those above
/// it, or, as inside a container, what is mounted of them.
std::uint64_t left_in_groups(const fs::path& root) {
    const fs::path mounted = root / "sys/fs/cgroup";
    std::uint64_t left = std::min(left_in_group(mounted, k_version_2),
                                  left_in_group(mounted / "memory", k_version_1));
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
            left =
                std::min(left, is_second ? left_in_group(mounted / name, k_version_2)
                                         : left_in_group(mounted / "memory" / name, k_version_1));
    }
    return left;
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

std::uint64_t available_memory_bytes(const fs::path& root) {
    return std::min({available_on_the_machine(root), left_in_groups(root),
                     left_of_address_space(root), left_of_data(root)});
}

InputError lack_of_memory(double bytes, std::string_view what, std::string_view mend) {
    return InputError(fmt::format("{} {:.3g} GB of memory, but only {:.3g} GB are free; {}", what,
                                  bytes * 1e-9,
                                  static_cast<double>(available_memory_bytes()) * 1e-9, mend));
}

void require_memory(double bytes, std::string_view what, std::string_view mend) {
    if (bytes > static_cast<double>(available_memory_bytes()))
        throw lack_of_memory(bytes, what, mend);
}

}  // namespace uw
