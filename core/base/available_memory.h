#pragma once

#include <cstdint>

namespace uw {

/// Memory that this process can still get without driving the machine out of it [bytes]: what Linux
/// holds available, free swap included, and no more than the limit of the process's control group
/// (a container's). The largest number there is where neither can be read.
std::uint64_t available_memory_bytes();

}  // namespace uw
