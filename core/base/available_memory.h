#pragma once

#include <cstdint>

namespace uw {

/// Memory that this process can still allocate without exhausting the machine's [bytes]: what Linux
/// reports as available, including free swap, but at most the limit of the process's control group
/// (container). The largest representable number if neither can be read.
std::uint64_t available_memory_bytes();

}  // namespace uw
