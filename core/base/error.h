#pragma once

#include <atomic>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>

namespace uw {

/// The location of an entry in the scene file, for messages: "plume.yaml:14:7: volumes[0].file".
/// For an entry that is not in a file, its key path alone, or empty.
using SourceLocation = std::string;

/// A user's file (scene, VDB, mesh) is wrong. `what()` is one line: where, what, how to fix it. The
/// program ends with exit code 3.
class InputError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A file cannot be read or written. One line; exit code 4.
class IoError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Wrong use of the command line. One line; exit code 2.
class UsageError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The user requested a stop (Ctrl-C). `what()` states what was written. Exit code 130.
class Interrupted : public std::runtime_error {
  public:
    Interrupted() : std::runtime_error("interrupted; nothing was written") {}
    using std::runtime_error::runtime_error;
};

/// The line for the user: what(), or advice if memory could not be allocated.
inline const char* line_of(const std::exception& error) {
    if (!dynamic_cast<const std::bad_alloc*>(&error)) return error.what();
    return "out of memory; render a smaller --size or --crop, fewer --layers or a --quality draft, "
           "or use smaller volumes, meshes and textures";
}

/// As long as it lives, the work of its thread, and of the threads that it runs by parallel_for,
/// ends with Interrupted once `stop` is set, at the next throw_if_stopped(). A nested one replaces
/// it temporarily.
class StopScope {
  public:
    explicit StopScope(const std::atomic<bool>& stop) : StopScope(&stop) {}
    /// Null: nothing stops the work.
    explicit StopScope(const std::atomic<bool>* stop);
    ~StopScope();
    StopScope(const StopScope&) = delete;
    StopScope& operator=(const StopScope&) = delete;
    StopScope(StopScope&&) = delete;
    StopScope& operator=(StopScope&&) = delete;

    /// The flag of the calling thread; null if there is none.
    static const std::atomic<bool>* of_this_thread();

  private:
    const std::atomic<bool>* previous_;
};

/// Throws Interrupted if the calling thread's work is to stop. It costs some nanoseconds: call it
/// before each ray, path or step, and at least every few milliseconds. Not to be called from within
/// Embree.
void throw_if_stopped();

}  // namespace uw
