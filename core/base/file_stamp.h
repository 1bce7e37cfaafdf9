#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>

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

}  // namespace uw
