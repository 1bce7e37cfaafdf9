#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace uw {

/// What tells whether a file is the one that was read, and unchanged, without reading it again.
struct FileStamp {
    dev_t device = 0;
    ino_t number = 0;
    std::uint64_t bytes = 0;
    std::int64_t modified_s = 0, modified_ns = 0;

    friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

/// Of the file that a name leads to; none if there is none.
std::optional<FileStamp> stamp_of(const std::filesystem::path& file);

/// Remembers, until the program ends, that `file` was opened to be read for the user: AtomicFile
/// never replaces it. To be called by whatever opens such a file, before it does. Throws InputError
/// if inputs are confined and `file` is not where they may be. Thread safe.
void remember_input(const std::filesystem::path& file);

/// From now on, until the program ends, all inputs have to lie in the folder of the first of them
/// or below it, after symbolic links: what a scene from a stranger names cannot lead elsewhere.
void confine_inputs();

/// The files remembered so far that lie, after symbolic links, neither in `folder` nor below it:
/// absolute, in alphabetical order. Thread safe.
std::vector<std::filesystem::path> inputs_outside(const std::filesystem::path& folder);

/// Whether `file` is one of those, by whatever name, symbolic or hard link. Thread safe.
bool is_input(const std::filesystem::path& file);

}  // namespace uw
