#include "core/base/input_files.h"

#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "core/base/file_stamp.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

using Identity = std::pair<dev_t, ino_t>;

Identity identity_of(const FileStamp& stamp) {
    return {stamp.device, stamp.number};
}

struct Input {
    fs::path file;  // absolute
    FileStamp stamp;
};

/// Of the whole program: what one part of it reads no other part may replace.
struct Registry {
    std::mutex mutex;
    std::multimap<Identity, Input> inputs;
};

Registry& registry() {
    static Registry all;
    return all;
}

bool is_as_old(const FileStamp& a, const FileStamp& b) {
    return a.modified_s == b.modified_s && a.modified_ns == b.modified_ns;
}

}  // namespace

void remember_input(const fs::path& file) {
    const std::optional<FileStamp> stamp = stamp_of(file);
    if (!stamp) return;
    std::error_code error;
    fs::path absolute = fs::absolute(file, error);
    if (error) absolute = file;
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    const auto [begin, end] = all.inputs.equal_range(identity_of(*stamp));
    for (auto input = begin; input != end; ++input) {
        if (input->second.file != absolute) continue;
        input->second.stamp = *stamp;
        return;
    }
    all.inputs.emplace(identity_of(*stamp), Input{std::move(absolute), *stamp});
}

// A file that was deleted may have left its number to another one: that is not an input unless it
// is as old as the input was, or has its name.
bool is_input(const fs::path& file) {
    const std::optional<FileStamp> stamp = stamp_of(file);
    if (!stamp) return false;
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    const auto [begin, end] = all.inputs.equal_range(identity_of(*stamp));
    for (auto input = begin; input != end; ++input) {
        if (is_as_old(input->second.stamp, *stamp)) return true;
        const std::optional<FileStamp> now = stamp_of(input->second.file);
        if (now && identity_of(*now) == identity_of(*stamp)) return true;
    }
    return false;
}

}  // namespace uw
