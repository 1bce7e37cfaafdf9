#pragma once

#include <filesystem>
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

/// The program or library that this code is in, or an empty path where the system does not tell.
std::filesystem::path own_file();

/// What to do where a module is not there, for a message. A `program` that came as a Debian package
/// gets it with the package `package`; one that was built from source, by scripts/demo, which says
/// more if the program has been installed from there.
std::string how_to_install(std::string_view package,
                           const std::filesystem::path& program = own_file());

/// The function `symbol` of the module `name`, which stays loaded until the program ends.
ModuleFunction load_function(const char* name, const char* symbol);

}  // namespace uw
