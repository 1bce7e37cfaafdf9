#include "core/base/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <system_error>

#include "core/base/error.h"
#include "core/base/input_files.h"

namespace uw {

namespace {

// Files are read in parts, each as long as all before.
constexpr std::size_t k_first_part = std::size_t{1} << 18;

}  // namespace

std::string read_text_file(const std::filesystem::path& file, const std::string& subject,
                           std::size_t most_bytes, std::string_view noun) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found)
        throw IoError(fmt::format("{}: no such file; check the name of the {}", subject, noun));
    if (std::filesystem::is_directory(status))
        throw IoError(fmt::format("{}: is a folder; name the {} in it", subject, noun));
    if (std::filesystem::is_character_file(status) || std::filesystem::is_block_file(status))
        throw IoError(fmt::format("{}: is a device; name the {}", subject, noun));
    remember_input(file);
    std::ifstream stream(file, std::ios::binary);
    std::string text;
    while (stream && text.size() <= most_bytes) {
        const std::size_t had = text.size();
        text.resize(std::min(had + std::max(had, k_first_part), most_bytes + 1));
        stream.read(&text[had], static_cast<std::streamsize>(text.size() - had));
        text.resize(had + static_cast<std::size_t>(stream.gcount()));
    }
    if (!stream.is_open() || stream.bad())
        throw IoError(fmt::format("{}: cannot be read; check its permissions", subject));
    if (text.size() > most_bytes)
        throw InputError(fmt::format("{}: is larger than {} MiB; this is not a valid {}", subject,
                                     most_bytes >> 20, noun));
    return text;
}

}  // namespace uw
