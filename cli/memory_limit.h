#pragma once

namespace uw {

/// From here on an allocation fails once the process would take more than the memory that is
/// available now (available_memory_bytes()): the run ends with one line. Without, Linux grants more
/// than it has, and kills the process that uses it, or another one.
void limit_memory();

/// Programs that are started while it lives have the limit of before.
class MemoryLimitLifted {
  public:
    MemoryLimitLifted();
    ~MemoryLimitLifted();
    MemoryLimitLifted(const MemoryLimitLifted&) = delete;
    MemoryLimitLifted& operator=(const MemoryLimitLifted&) = delete;
};

}  // namespace uw
