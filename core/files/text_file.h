#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace uw {

/// The unmodified contents of a text file of at most `most_bytes`. Messages begin with `subject`
/// ("plume.yaml", or the scene entry that names the file, followed by the file) and call what was
/// expected `noun` ("scene", "IES file"). Throws IoError if the file does not exist, is a folder,
/// or cannot be read; InputError if it is larger. A pipe is read until it ends or the limit is
/// exceeded; one that nobody writes to is empty.
std::string read_text_file(const std::filesystem::path& file, const std::string& subject,
                           std::size_t most_bytes, std::string_view noun);

}  // namespace uw
