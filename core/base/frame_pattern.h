#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace uw {

/// Patterns for the frame number in file names:
///
///     %d %04d   #  ####   $F $F4   {frame} {frame:04d}
///
/// The number is padded with zeros to the given width, or to as many digits as there are #, and is
/// never truncated. "$F" before a letter and "%4d" (blanks in names) are not patterns.
bool has_frame_pattern(std::string_view name);

/// `name` with `frame` (>= 0) substituted for all patterns.
std::string expand_frame_pattern(std::string_view name, int frame);

/// The file of one frame. Folders that exist under their literal name are taken literally.
std::filesystem::path file_of_frame(const std::filesystem::path& name, int frame);

/// The frames for which a file exists, ascending; the number must be part of the file's own name,
/// not its folder's. Empty if there is no such folder.
std::vector<int> frames_found(const std::filesystem::path& name);

/// Whether the files of two frames differ.
bool differs_by_frame(const std::filesystem::path& name);

}  // namespace uw
