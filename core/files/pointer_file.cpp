#include "core/files/pointer_file.h"

#include <fstream>
#include <string_view>
#include <system_error>

namespace uw {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_lfs =
    "is a Git LFS pointer, not the file itself; fetch its content with 'git lfs pull'";
constexpr const char* k_annex =
    "is a git-annex pointer, not the file itself; fetch its content with 'git annex get'";

}  // namespace

std::string stand_in_of(const fs::path& file) {
    std::error_code error;
    if (fs::is_symlink(file, error) && !fs::exists(file, error) &&
        fs::read_symlink(file, error).generic_string().find("annex/objects/") != std::string::npos)
        return k_annex;
    if (!fs::is_regular_file(file, error)) return "";
    std::string beginning(256, '\0');
    std::ifstream in(file, std::ios::binary);
    in.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
    beginning.resize(static_cast<std::size_t>(in.gcount()));
    if (beginning.starts_with("version https://git-lfs.github.com/spec/") ||
        beginning.starts_with("version https://hawser.github.com/spec/"))
        return k_lfs;
    // An unlocked file's pointer, or a link where the file system has none.
    const std::string_view line = std::string_view(beginning).substr(0, beginning.find('\n'));
    const bool is_text = line.find('\0') == std::string_view::npos;
    if (is_text && (line.starts_with("/annex/objects/") ||
                    line.find(".git/annex/objects/") != std::string_view::npos))
        return k_annex;
    return "";
}

}  // namespace uw
