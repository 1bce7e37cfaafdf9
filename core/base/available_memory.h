#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace uw {

/// Thrown if memory is not available at present, although the machine has as much. `what()` is one
/// line. The program ends with exit code 1.
class OutOfMemory : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// How much memory this process may still allocate, at one moment [bytes]; the largest
/// representable number where nothing is known or limits it.
struct FreeMemory {
    /// The memory that other processes leave: the least of what Linux reports as available,
    /// including free swap, and of the rest of the limits of its control group (container) and of
    /// those above, of either version, counting cached files as free. It changes with all that runs
    /// on the machine.
    std::uint64_t shared = 0;
    /// The rest of its own limits of address space (ulimit -v) and of data (ulimit -d).
    std::uint64_t own = 0;
    /// The value that `shared` would have if nothing else ran.
    std::uint64_t most = 0;

    std::uint64_t available() const { return shared < own ? shared : own; }
};

/// `root`: of the file system, for tests.
FreeMemory read_free_memory(const std::filesystem::path& root = "/");

/// FreeMemory::available now: memory that this process can allocate without exhausting what it may
/// use [bytes].
std::uint64_t available_memory_bytes(const std::filesystem::path& root = "/");

/// What counts towards this process's limit of data [bytes]: what it has allocated, used or not.
std::uint64_t data_bytes(const std::filesystem::path& root = "/");

/// How require_memory waits for memory that other processes use: a busy machine may lack some for a
/// moment.
struct MemoryWait {
    double seconds = 1;  ///< the longest wait
    /// Called once, after a second, with the line that would be thrown; may be empty.
    std::function<void(const std::string& line)> tell{};
    // For tests.
    std::function<FreeMemory()> read = [] { return read_free_memory(); };
    std::function<void(double seconds)> sleep{};  ///< empty: sleeps, and ends if it is to stop
};

/// As long as it lives, require_memory waits on this thread as `wait` specifies, which must outlive
/// it.
class MemoryWaitScope {
  public:
    explicit MemoryWaitScope(const MemoryWait& wait);
    ~MemoryWaitScope();
    MemoryWaitScope(const MemoryWaitScope&) = delete;
    MemoryWaitScope& operator=(const MemoryWaitScope&) = delete;
    MemoryWaitScope(MemoryWaitScope&&) = delete;
    MemoryWaitScope& operator=(MemoryWaitScope&&) = delete;

    /// How require_memory waits on the calling thread.
    static const MemoryWait& of_this_thread();

  private:
    const MemoryWait* previous_;
};

/// Returns once `bytes` are available. Throws InputError if they are more than the machine, or its
/// control group, has at all, OutOfMemory if they are not there after MemoryWait::seconds or if
/// limits of this process forbid them: "WHAT 1.2 GB of memory, but only 0.8 GB are free; HINT". To
/// be called first: Linux grants more memory than it has, and kills the process that uses it.
void require_memory(double bytes, std::string_view what, std::string_view hint);

/// From here on an allocation fails once the process would take more than the memory that is
/// available now, less a sixteenth: the run ends with one line. Without, Linux grants more than it
/// has, and kills the process that uses it, or another one.
void limit_memory();

/// Updates that limit, if there is one, by the memory that is available now: it may have been set
/// at a moment when other programs used most of it. To be called from time to time.
void renew_memory_limit();

/// Programs that are started while it lives have the previous limit.
class MemoryLimitLifted {
  public:
    MemoryLimitLifted();
    ~MemoryLimitLifted();
    MemoryLimitLifted(const MemoryLimitLifted&) = delete;
    MemoryLimitLifted& operator=(const MemoryLimitLifted&) = delete;
    MemoryLimitLifted(MemoryLimitLifted&&) = delete;
    MemoryLimitLifted& operator=(MemoryLimitLifted&&) = delete;
};

}  // namespace uw
