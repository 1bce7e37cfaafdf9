#include "tests/bench/support/process.h"

#include <malloc.h>
#include <time.h>

#include <fstream>
#include <string>

#include "core/base/error.h"

namespace uw::bench {

double process_cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void reset_peak_memory() {
    malloc_trim(0);
    std::ofstream out("/proc/self/clear_refs");
    out << "5" << std::flush;
    if (!out)
        throw IoError("/proc/self/clear_refs: cannot write: peak memory cannot be measured here");
}

double peak_memory_mb() {
    std::ifstream in("/proc/self/status");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("VmHWM:")) return 1.024e-3 * std::stod(line.substr(6));
    throw IoError("/proc/self/status: has no VmHWM: peak memory cannot be measured here");
}

}  // namespace uw::bench
