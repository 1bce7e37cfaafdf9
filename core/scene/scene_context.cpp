#include "core/scene/scene_context.h"

#include <fmt/format.h>

#include <stdexcept>
#include <system_error>

#include "core/base/input_files.h"
#include "core/base/text.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_longest_name = 64;

/// Whether `path` is `pattern`, in which a * stands for any text.
bool matches(std::string_view path, std::string_view pattern) {
    const std::size_t star = pattern.find('*');
    if (star == std::string_view::npos) return path == pattern;
    if (!path.starts_with(pattern.substr(0, star))) return false;
    path.remove_prefix(star);
    pattern.remove_prefix(star + 1);
    for (std::size_t skipped = 0; skipped <= path.size(); ++skipped)
        if (matches(path.substr(skipped), pattern)) return true;
    return false;
}

const FileKey& file_key_of(const ConfigValue& value) {
    for (const FileKey& key : k_file_keys)
        if (matches(value.path(), key.path)) return key;
    throw std::logic_error(value.path() + " is not among k_file_keys");
}

fs::path read_file(const ConfigValue& value, const SceneContext& context, bool* is_sequence) {
    const FileKey& key = file_key_of(value);
    constexpr std::size_t k_longest_file_name = 4096;
    const std::string name = value.text("give the name of a file");
    if (name.size() > k_longest_file_name) value.fail("is too long for a file name; shorten it");
    fs::path file = context.folder / name;
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (status.type() == fs::file_type::not_found) {
        if (is_sequence != nullptr && has_frame_pattern(name)) {
            *is_sequence = true;
            if (context.files != nullptr) context.files->push_back({&key, file, true});
            return file;
        }
        if (const std::string stand_in = stand_in_of(file); !stand_in.empty())
            value.fail(fmt::format("'{}' {}", printable(name, 200), stand_in));
        const fs::path folder = file.parent_path().empty() ? "." : file.parent_path();
        value.fail(
            fmt::format("no such file '{}' (looked in {}); names are relative to the scene "
                        "file's folder",
                        printable(name, 200), printable(folder.string(), 300)));
    }
    if (error) {
        value.fail(fmt::format("cannot access '{}': {}; check the permissions of its folder",
                               printable(name, 200), error.message()));
    }
    if (fs::is_directory(status)) {
        value.fail(fmt::format("'{}' is a folder; name a file in it", printable(name, 200)));
    }
    // A pipe would block the program, a device might never end.
    if (!fs::is_regular_file(status)) {
        value.fail(fmt::format("'{}' is a pipe or device; name a file", printable(name, 200)));
    }
    admit_input(file, value.location(), "file");
    if (context.files != nullptr) context.files->push_back({&key, file});
    return file;
}

}  // namespace

fs::path read_existing_file(const ConfigValue& value, const SceneContext& context) {
    return read_file(value, context, nullptr);
}

fs::path read_existing_file_or_sequence(const ConfigValue& value, const SceneContext& context,
                                        bool& is_sequence) {
    is_sequence = false;
    return read_file(value, context, &is_sequence);
}

void fail_not_in_memory(const ConfigValue& value, const std::string& name) {
    value.fail(
        fmt::format("nothing in memory is called '{}'; only scenes in Python have it, by "
                    "scene.volumes.add and scene.geometry.add: name a file instead",
                    printable(name)));
}

std::string read_short_name(const ConfigValue& value, std::string_view of, std::string_view hint) {
    constexpr std::string_view k_allowed =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    std::string name = value.text(hint);
    if (name.find_first_not_of(k_allowed) != std::string::npos || name.size() > k_longest_name) {
        value.fail(
            fmt::format("'{}' cannot be part of {}; use only letters, digits, _ and -, at "
                        "most {} of them",
                        printable(name), of, k_longest_name));
    }
    return name;
}

}  // namespace uw
