#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "core/base/error.h"

namespace uw {

/// Memory that this process can still allocate without exhausting what it may use [bytes], the
/// least of
/// - what Linux reports as available, including free swap;
/// - what the limits of its control group (container) and of those above leave, of either version,
///   counting cached files as free;
/// - what its limits of address space (ulimit -v) and of data (ulimit -d) leave.
/// The largest representable number if none can be read. `root`: of the file system, for tests.
std::uint64_t available_memory_bytes(const std::filesystem::path& root = "/");

/// What counts towards this process's limit of data [bytes]: what it has allocated, used or not.
std::uint64_t data_bytes(const std::filesystem::path& root = "/");

/// What is said of `bytes` that cannot be had: "WHAT 1.2 GB of memory, but only 0.8 GB are free;
/// MEND".
InputError lack_of_memory(double bytes, std::string_view what, std::string_view mend);

/// Throws lack_of_memory() if `bytes` are more than is available. To be called first: Linux grants
/// more memory than it has, and kills the process that uses it.
void require_memory(double bytes, std::string_view what, std::string_view mend);

}  // namespace uw
