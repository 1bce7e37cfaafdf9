#include "core/files/input_files.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"

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
    bool is_confined = false;
    std::optional<fs::path> confines;  // once an input was named
};

Registry& registry() {
    static Registry all;
    return all;
}

/// Both are canonical.
bool lies_in(const fs::path& folder, const fs::path& file) {
    return std::ranges::mismatch(folder, file).in1 == folder.end();
}

// Precondition: the registry is locked.
void check_confines(const fs::path& file, Registry& all) {
    if (!all.is_confined) return;
    std::error_code error;
    const fs::path place = fs::weakly_canonical(file, error);
    if (!all.confines) all.confines = place.parent_path();
    const fs::path& folder = *all.confines;
    if (!error && lies_in(folder, place)) return;
    throw InputError(fmt::format("{}: lies outside '{}', to which --confine keeps what is read",
                                 printable(file.string()), printable(folder.string())));
}

bool is_as_old(const FileStamp& a, const FileStamp& b) {
    return a.modified_s == b.modified_s && a.modified_ns == b.modified_ns;
}

}  // namespace

std::optional<FileStamp> stamp_of(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return std::nullopt;
    return FileStamp{status.st_dev, status.st_ino, static_cast<std::uint64_t>(status.st_size),
                     status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

void confine_inputs() {
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    all.is_confined = true;
}

void remember_input(const fs::path& file) {
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    check_confines(file, all);
    const std::optional<FileStamp> stamp = stamp_of(file);
    if (!stamp) return;
    std::error_code error;
    fs::path absolute = fs::absolute(file, error);
    if (error) absolute = file;
    const auto [begin, end] = all.inputs.equal_range(identity_of(*stamp));
    for (auto input = begin; input != end; ++input) {
        if (input->second.file != absolute) continue;
        input->second.stamp = *stamp;
        return;
    }
    all.inputs.emplace(identity_of(*stamp), Input{std::move(absolute), *stamp});
}

std::vector<fs::path> inputs_outside(const fs::path& folder) {
    std::error_code error;
    const fs::path place = fs::weakly_canonical(folder, error);
    std::vector<fs::path> outside;
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    for (const auto& [identity, input] : all.inputs) {
        const fs::path file = fs::weakly_canonical(input.file, error);
        if (!lies_in(place, error ? input.file : file))
            outside.push_back(error ? input.file : file);
    }
    std::ranges::sort(outside);
    outside.erase(std::unique(outside.begin(), outside.end()), outside.end());
    return outside;
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
