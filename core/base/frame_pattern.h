#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace uw {

/// Places for a frame's number in the names of files:
///
///     %d %04d   #  ####   $F $F4   {frame} {frame:04d}
///
/// The number is filled up with zeros to the width given, or to as many digits as there are #, and
/// is never cut. "$F" before a letter and "%4d" (blanks in names) are none.
bool has_frame_pattern(std::string_view name);

/// `name` with `frame` (>= 0) in all of its places.
std::string expand_frame_pattern(std::string_view name, int frame);

/// The file of one frame. Folders that exist as they are written are taken as written.
std::filesystem::path file_of_frame(const std::filesystem::path& name, int frame);

/// The frames for which there is a file, ascending; the number must stand in the file's own name,
/// not in its folder's. Empty if there is no such folder.
std::vector<int> frames_found(const std::filesystem::path& name);

/// Whether the files of two frames differ.
bool differs_by_frame(const std::filesystem::path& name);

}  // namespace uw
