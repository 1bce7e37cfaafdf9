#pragma once

/// What this process uses, as the system counts it.
namespace uw::bench {

/// CPU time of all threads since the process began [s].
double process_cpu_seconds();

/// Gives freed memory back and lets peak_memory_mb() count from now on. Throws IoError if the
/// system does not allow it (Linux: /proc/self/clear_refs).
void reset_peak_memory();

/// Most memory held at once since the last reset [10^6 bytes], the program itself included.
double peak_memory_mb();

}  // namespace uw::bench
