#include <fmt/format.h>

#include <regex>
#include <system_error>

#include "core/config_text.h"
#include "core/scene_sections.h"

namespace uw {
namespace {

/// Names of one file per frame: plume_%04d.vdb, plume_####.vdb, plume_$F4.vdb, plume_{frame}.vdb.
bool has_frame_pattern(const std::string& name) {
    static const std::regex pattern(R"(%0?[0-9]*d|#+|\$F[0-9]*|\{frame\})");
    return std::regex_search(name, pattern);
}

}  // namespace

std::filesystem::path read_existing_file(const ConfigValue& value, const SceneContext& context) {
    namespace fs = std::filesystem;
    constexpr std::size_t k_longest_name = 4096;
    const std::string name = value.text("give the name of a file");
    if (name.size() > k_longest_name) value.fail("is too long for a file name; shorten it");
    fs::path file = context.folder / name;
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (status.type() == fs::file_type::not_found) {
        if (has_frame_pattern(name)) {
            value.fail(fmt::format("sequences are not supported yet ('{}'); name one file",
                                   printable(name, 200)));
        }
        const fs::path folder = file.parent_path().empty() ? "." : file.parent_path();
        value.fail(
            fmt::format("no such file '{}' (looked in {}); names are relative to the scene "
                        "file's folder",
                        printable(name, 200), printable(folder.string(), 300)));
    }
    if (error) {
        value.fail(fmt::format("cannot look at '{}': {}; check the permissions of its folder",
                               printable(name, 200), error.message()));
    }
    if (fs::is_directory(status)) {
        value.fail(fmt::format("'{}' is a folder; name a file in it", printable(name, 200)));
    }
    // A pipe would keep the program waiting, a device might never end.
    if (!fs::is_regular_file(status)) {
        value.fail(fmt::format("'{}' is a pipe or device; name a file", printable(name, 200)));
    }
    return file;
}

}  // namespace uw
