#include "core/base/input_files.h"

#include <sys/stat.h>

#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace uw {

namespace {

namespace fs = std::filesystem;

using Identity = std::pair<dev_t, ino_t>;

struct FileState {
    Identity identity;
    timespec modified;
};

std::optional<FileState> state_of(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return std::nullopt;
    return FileState{{status.st_dev, status.st_ino}, status.st_mtim};
}

struct Input {
    fs::path file;  // absolute
    timespec modified;
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

bool is_same(const timespec& a, const timespec& b) {
    return a.tv_sec == b.tv_sec && a.tv_nsec == b.tv_nsec;
}

}  // namespace

void remember_input(const fs::path& file) {
    const std::optional<FileState> state = state_of(file);
    if (!state) return;
    std::error_code error;
    fs::path absolute = fs::absolute(file, error);
    if (error) absolute = file;
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    const auto [begin, end] = all.inputs.equal_range(state->identity);
    for (auto input = begin; input != end; ++input) {
        if (input->second.file != absolute) continue;
        input->second.modified = state->modified;
        return;
    }
    all.inputs.emplace(state->identity, Input{std::move(absolute), state->modified});
}

// A file that was deleted may have left its number to another one: that is not an input unless it
// is as old as the input was, or has its name.
bool is_input(const fs::path& file) {
    const std::optional<FileState> state = state_of(file);
    if (!state) return false;
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    const auto [begin, end] = all.inputs.equal_range(state->identity);
    for (auto input = begin; input != end; ++input) {
        if (is_same(input->second.modified, state->modified)) return true;
        const std::optional<FileState> now = state_of(input->second.file);
        if (now && now->identity == state->identity) return true;
    }
    return false;
}

}  // namespace uw
