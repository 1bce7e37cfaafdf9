#include <algorithm>
#include <cstddef>
#include <cstdlib>

// Takes the place of oneTBB's allocator under the thread sanitizer (UWVDB_STD_THREADS), since
// oneTBB uses a libtbbmalloc.so.2 that is loaded already. Its own hands memory from one thread to
// another by locks and counters that are compiled without the sanitizer, which then takes what both
// write there for a race. The sanitizer knows the C library's memory. Nothing is freed, since it
// does not see the counters that tell when nobody needs it.
extern "C" {

void* scalable_malloc(std::size_t bytes) {
    return std::malloc(bytes);
}

void* scalable_aligned_malloc(std::size_t bytes, std::size_t alignment) {
    void* memory = nullptr;
    return posix_memalign(&memory, std::max(alignment, sizeof(void*)), bytes) == 0 ? memory
                                                                                   : nullptr;
}

void scalable_free(void* /*memory*/) {}

void scalable_aligned_free(void* /*memory*/) {}

}  // extern "C"
