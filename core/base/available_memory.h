#pragma once

#include <cstdint>
#include <filesystem>

namespace uw {

/// Memory that this process can still allocate without exhausting what it may use [bytes], the
/// least of
/// - what Linux reports as available, including free swap;
/// - what the limits of its control group (container) and of those above leave, of either version,
///   counting cached files as free;
/// - what its limit of address space (ulimit -v) leaves.
/// The largest representable number if none can be read. `root`: of the file system, for tests.
std::uint64_t available_memory_bytes(const std::filesystem::path& root = "/");

}  // namespace uw
