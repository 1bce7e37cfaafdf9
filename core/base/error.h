#pragma once

#include <exception>
#include <new>
#include <stdexcept>
#include <string>

namespace uw {

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

/// The line for the user: what(), or what to do where memory could not be had.
inline const char* line_of(const std::exception& error) {
    if (!dynamic_cast<const std::bad_alloc*>(&error)) return error.what();
    return "out of memory; render a smaller --size or --crop, fewer --layers or a --quality draft, "
           "or use smaller volumes, meshes and textures";
}

}  // namespace uw
