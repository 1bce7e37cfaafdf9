#pragma once

#include <string>
#include <string_view>

namespace uw {

/// Modules: parts of the program that it loads when they are first needed, since the libraries
/// behind them would cost every start time. They lie in lib/uwvdb of the nearest folder above the
/// program or library that this code is in: of an installation, a build folder or a Python
/// environment.

/// A function that a module exports, or why there is none.
struct ModuleFunction {
    void* address = nullptr;
    std::string fault;
};

/// What to do where a module is not there, for a message: it comes with the package `package`, and
/// a build from source has it where `development` is installed when CMake looks.
std::string how_to_install(std::string_view package, std::string_view development);

/// The function `symbol` of the module `name`, which stays loaded until the program ends.
ModuleFunction load_function(const char* name, const char* symbol);

}  // namespace uw
