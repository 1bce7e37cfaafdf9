#pragma once

/// Resources used by this process, as the system counts them.
namespace uw::bench {

/// CPU time of all threads since the process began [s].
double process_cpu_seconds();

/// Returns freed memory to the system and restarts the count of peak_memory_mb(). Throws IoError if
/// the system does not allow it (Linux: /proc/self/clear_refs).
void reset_peak_memory();

/// Peak memory since the last reset [10^6 bytes], the program itself included.
double peak_memory_mb();

}  // namespace uw::bench
