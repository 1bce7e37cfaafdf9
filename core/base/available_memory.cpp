#include "core/base/available_memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace uw {

namespace {

constexpr std::uint64_t k_unknown = std::numeric_limits<std::uint64_t>::max();

// MemAvailable and SwapFree of /proc/meminfo, "MemAvailable:   21333764 kB".
std::uint64_t available_on_the_machine() {
    std::ifstream in("/proc/meminfo");
    std::uint64_t kilobytes = 0, value = 0;
    bool found = false;
    for (std::string key, unit; in >> key >> value; std::getline(in, unit)) {
        if (key != "MemAvailable:" && key != "SwapFree:") continue;
        found = found || key == "MemAvailable:";
        kilobytes += value;
    }
    return found ? kilobytes * 1024 : k_unknown;
}

// Inside a container its own control group is the root; a number of bytes, or "max".
std::uint64_t limit_of_the_control_group() {
    std::ifstream in("/sys/fs/cgroup/memory.max");
    std::uint64_t bytes = 0;
    return in >> bytes ? bytes : k_unknown;
}

}  // namespace

std::uint64_t available_memory_bytes() {
    return std::min(available_on_the_machine(), limit_of_the_control_group());
}

}  // namespace uw
