// Preloaded into the program by tests/cli/faults: fails one call to the system, the one that the
// environment variable UWVDB_FAIL names, "write:3" for the third of its kind, and then creates the
// file UWVDB_FAIL_DONE. Kinds: open (to write), write, rename, fsync, allocate (1 MiB or more),
// map, thread. "stop:3" is Ctrl-C as the third write begins, which does not fail. "space:1000000"
// is a disk with so many bytes free, "quota:1000000" one on which the user may write as many: what
// is beyond is not written, and nothing from then on. Neither writes to anything but files are
// counted nor what libraries do as they are loaded.

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstddef>
#include <cstdlib>
#include <cstring>

extern "C" {

void* __libc_malloc(std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);

namespace {

std::atomic<long> calls{0}, written{0};
// Set as the last libraries are: those preloaded come after what they do not depend on.
bool is_loaded = false;
__attribute__((constructor)) void begin_counting() {
    is_loaded = true;
}

/// The number after the kind; -1 if another kind is to fail.
long number_of(const char* kind) {
    const char* const fault = std::getenv("UWVDB_FAIL");
    if (fault == nullptr || !is_loaded) return -1;
    const std::size_t length = std::strlen(kind);
    if (std::strncmp(fault, kind, length) != 0 || fault[length] != ':') return -1;
    return std::atol(fault + length + 1);
}

void note_failure() {
    if (const char* const done = std::getenv("UWVDB_FAIL_DONE"))
        ::syscall(SYS_close, ::syscall(SYS_openat, AT_FDCWD, done, O_WRONLY | O_CREAT, 0600));
}

/// Whether this call of the kind is the one to fail.
bool is_due(const char* kind) {
    const long number = number_of(kind);
    if (number < 0 || ++calls != number) return false;
    note_failure();
    return true;
}

/// How many of `bytes` are written; -1, with errno, if none are.
ssize_t room_for(std::size_t bytes) {
    if (is_due("stop")) ::raise(SIGINT);
    if (is_due("write")) {
        errno = ENOSPC;
        return -1;
    }
    const bool is_quota = number_of("quota") >= 0;
    const long room = is_quota ? number_of("quota") : number_of("space");
    const auto wanted = static_cast<ssize_t>(bytes);
    if (room < 0) return wanted;
    const ssize_t left = room - written.fetch_add(wanted);
    if (left >= wanted) return wanted;
    note_failure();
    if (left > 0) return left;
    errno = is_quota ? EDQUOT : ENOSPC;
    return -1;
}

bool is_regular(int file) {
    struct stat status {};
    return file > STDERR_FILENO && ::fstat(file, &status) == 0 && S_ISREG(status.st_mode);
}

constexpr std::size_t k_large = std::size_t{1} << 20;

bool fails_allocation(std::size_t bytes) {
    if (bytes < k_large || !is_due("allocate")) return false;
    errno = ENOMEM;
    return true;
}

}  // namespace

ssize_t write(int file, const void* data, std::size_t bytes) {
    if (!is_regular(file)) return ::syscall(SYS_write, file, data, bytes);
    const ssize_t room = room_for(bytes);
    return room < 0 ? -1 : ::syscall(SYS_write, file, data, room);
}

ssize_t writev(int file, const iovec* parts, int count) {
    if (!is_regular(file)) return ::syscall(SYS_writev, file, parts, count);
    std::size_t bytes = 0;
    for (int n = 0; n < count; ++n) bytes += parts[n].iov_len;
    const ssize_t room = room_for(bytes);
    if (room == static_cast<ssize_t>(bytes)) return ::syscall(SYS_writev, file, parts, count);
    // No more than the first part, so that what is there remains in order.
    const std::size_t first = parts[0].iov_len;
    return room < 0 ? -1
                    : ::syscall(SYS_write, file, parts[0].iov_base,
                                std::min(first, static_cast<std::size_t>(room)));
}

void* mmap(void* at, std::size_t bytes, int protection, int flags, int file,
           off_t offset) noexcept {
    if (is_due("map")) {
        errno = ENOMEM;
        return MAP_FAILED;
    }
    // NOLINTNEXTLINE(performance-no-int-to-ptr)
    return reinterpret_cast<void*>(::syscall(SYS_mmap, at, bytes, protection, flags, file, offset));
}

int fsync(int file) {
    if (is_due("fsync")) {
        errno = EIO;
        return -1;
    }
    return static_cast<int>(::syscall(SYS_fsync, file));
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*),
                   void* argument) noexcept {
    if (is_due("thread")) return EAGAIN;
    using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
    static const auto create = reinterpret_cast<Create>(::dlsym(RTLD_NEXT, "pthread_create"));
    return create(thread, attributes, run, argument);
}

int rename(const char* from, const char* to) noexcept {
    if (is_due("rename")) {
        errno = EDQUOT;
        return -1;
    }
    return static_cast<int>(::syscall(SYS_rename, from, to));
}

int open(const char* name, int flags, ...) {
    std::va_list rest;
    va_start(rest, flags);
    const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    if ((flags & O_ACCMODE) != O_RDONLY && is_due("open")) {
        errno = ENOSPC;
        return -1;
    }
    return static_cast<int>(::syscall(SYS_openat, AT_FDCWD, name, flags, mode));
}

void* malloc(std::size_t bytes) noexcept {
    return fails_allocation(bytes) ? nullptr : __libc_malloc(bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept {
    return fails_allocation(bytes) ? nullptr : __libc_memalign(alignment, bytes);
}

int posix_memalign(void** to, std::size_t alignment, std::size_t bytes) noexcept {
    if (fails_allocation(bytes)) return ENOMEM;
    *to = __libc_memalign(alignment, bytes);
    return *to != nullptr ? 0 : ENOMEM;
}

}  // extern "C"
