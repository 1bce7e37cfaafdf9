#pragma once

#include <filesystem>

namespace uw {

/// Remembers, until the program ends, that `file` was opened to be read for the user: AtomicFile
/// never replaces it. To be called by whatever opens such a file. Thread safe.
void remember_input(const std::filesystem::path& file);

/// Whether `file` is one of those, by whatever name, symbolic or hard link. Thread safe.
bool is_input(const std::filesystem::path& file);

}  // namespace uw
