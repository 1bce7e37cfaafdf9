#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace uw {

/// The whole of a text file of at most `most_bytes`, as it is. Messages begin with `subject`
/// ("plume.yaml", or the entry of a scene that names the file, and the file) and call what was
/// expected `noun`
/// ("scene", "IES file"). Throws IoError where there is no such file, where it is a folder, or
/// where it cannot be read; InputError where it is larger. A pipe is read until it ends or the
/// limit is passed.
std::string read_text_file(const std::filesystem::path& file, const std::string& subject,
                           std::size_t most_bytes, std::string_view noun);

}  // namespace uw
