#pragma once

#include <stdexcept>

namespace uw {

/// A request that was right, but not for the scene as it has become. One line.
class ConflictError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace uw
