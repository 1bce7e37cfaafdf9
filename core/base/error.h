#pragma once

#include <stdexcept>
#include <string>

namespace uw {

/// A user's file (scene, VDB, mesh) is wrong. `what()` is one line: where, what, how to mend.
/// The program ends with exit code 3.
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

/// The user asked to stop (Ctrl-C). `what()` says what there is of the work. Exit code 130.
class Interrupted : public std::runtime_error {
  public:
    Interrupted() : std::runtime_error("interrupted; nothing was written") {}
    using std::runtime_error::runtime_error;
};

}  // namespace uw
