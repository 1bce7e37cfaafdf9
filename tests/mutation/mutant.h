#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

/// What mutated sources include (scripts/mutate).
namespace uw {

/// As many as a file of marks holds.
constexpr int k_max_mutants = 1 << 16;

/// The mutant that this process runs with: the number in UWVDB_MUTANT, 0 for none.
inline const int running_mutant = [] {
    const char* number = std::getenv("UWVDB_MUTANT");
    return number ? std::atoi(number) : 0;
}();

/// A byte per mutant in the file that UWVDB_MUTANTS_REACHED names, or null. It is shared with other
/// processes, and what was written remains however this one ends.
inline char* const reached_mutants = []() -> char* {
    const char* path = std::getenv("UWVDB_MUTANTS_REACHED");
    const int file = path ? open(path, O_RDWR | O_CLOEXEC) : -1;
    if (file < 0) return nullptr;
    void* bytes = mmap(nullptr, k_max_mutants, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    close(file);
    return bytes == MAP_FAILED ? nullptr : static_cast<char*>(bytes);
}();

/// Whether the code of mutant `number` is to run, which it notes as reached.
inline bool is_mutant(int number) {
    if (__builtin_expect(reached_mutants != nullptr, 0)) reached_mutants[number] = 1;
    return number == running_mutant;
}

}  // namespace uw
