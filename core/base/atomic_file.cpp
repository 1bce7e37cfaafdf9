#include "core/base/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>

#include "core/base/error.h"
#include "core/base/input_files.h"

namespace uw {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& target, const std::string& why) {
    throw IoError(fmt::format("{}: cannot write: {}", target.string(), why));
}

/// Rejects targets that a rename must not replace, and resolves a symbolic link to its target.
fs::path checked(const fs::path& target) {
    if (!target.has_filename()) fail(target, "not a file name; add one");
    // Inaccessible paths are detected when the file is created, with a better message.
    std::error_code error;
    fs::path resolved = target;
    constexpr int k_most_links = 40;  // as many as Linux follows
    for (int links = 0; fs::is_symlink(fs::symlink_status(resolved, error)); ++links) {
        if (links == k_most_links) fail(target, "its symbolic links form a loop");
        // Relative to the link's folder; its target need not exist yet.
        resolved = resolved.parent_path() / fs::read_symlink(resolved, error);
        if (error) fail(target, error.message());
    }
    const fs::file_status status = fs::status(resolved, error);
    if (fs::is_directory(status)) fail(target, "it is a folder; add a file name");
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        fail(target, "it is not a regular file; choose another name");
    }
    return resolved;
}

std::string why_not_created(const fs::path& folder, int error) {
    switch (error) {
        case ENOENT:
            return fmt::format("the folder '{}' does not exist; create it first", folder.string());
        case ENOTDIR:
            return fmt::format("'{}' is not a folder; choose another folder", folder.string());
        case EACCES:
        case EPERM:
        case EROFS:
            return fmt::format("no permission to write in the folder '{}'; choose another folder",
                               folder.string());
        case ENOSPC:
        case EDQUOT:
            return "the disk is full; free some space or choose another folder";
        default:
            return fmt::format("{} in the folder '{}'", std::generic_category().message(error),
                               folder.string());
    }
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target, ReadTarget read_target)
    : read_target_(read_target), target_(checked(target)) {
    refuse_input(target);
    static std::atomic<unsigned> counter{0};
    const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
    // The process id alone is not unique among machines that share a folder; O_EXCL is.
    constexpr int k_attempts = 1000;
    int error = EEXIST;
    for (int attempt = 0; attempt < k_attempts && error == EEXIST; ++attempt) {
        temporary_ = folder / fmt::format(".uwvdb-{}-{}.tmp", ::getpid(), counter++);
        const int file = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file >= 0) {
            ::close(file);
            return;
        }
        error = errno;
    }
    fail(target_, why_not_created(folder, error));
}

AtomicFile::~AtomicFile() {
    std::error_code ignored;
    if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

void AtomicFile::refuse_input(const fs::path& name) const {
    if (read_target_ == ReadTarget::refuse && is_input(target_))
        fail(name, "it is a file that this run reads; choose another name");
}

void AtomicFile::keep_permissions() const {
    std::error_code error;
    const fs::file_status status = fs::status(target_, error);
    if (!fs::is_regular_file(status)) return;
    fs::permissions(temporary_, status.permissions(), error);
    if (error) fail(target_, error.message());
}

void AtomicFile::commit() {
    refuse_input(target_);  // it may have been read in the meantime
    if (read_target_ == ReadTarget::replace) keep_permissions();
    std::error_code error;
    fs::rename(temporary_, target_, error);
    if (error) fail(target_, error.message());
    temporary_.clear();
}

}  // namespace uw
