#pragma once

#include <filesystem>

namespace uw {

/// Remembers, until the program ends, that `file` was opened to be read for the user: AtomicFile
/// never replaces it. To be called by whatever opens such a file, before it does. Throws InputError
/// if inputs are confined and `file` is not where they may be. Thread safe.
void remember_input(const std::filesystem::path& file);

/// From now on, until the program ends, all inputs have to lie in the folder of the first of them
/// or below it, after symbolic links: what a scene from a stranger names cannot lead elsewhere.
void confine_inputs();

/// Whether `file` is one of those, by whatever name, symbolic or hard link. Thread safe.
bool is_input(const std::filesystem::path& file);

}  // namespace uw
