#include "core/base/output_files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>
#include <stdlib.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>

#include "core/base/error.h"
#include "core/base/input_files.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

constexpr const char* k_prefix = ".uwvdb-";

[[noreturn]] void fail(const fs::path& target, const std::string& why) {
    throw IoError(fmt::format("{}: cannot write: {}", target.string(), why));
}

/// Rejects targets that a rename must not replace, and resolves a symbolic link to its target.
fs::path checked(const fs::path& target) {
    if (!target.has_filename()) fail(target, "not a file name; add one");
    // Inaccessible paths are detected when the file is created, with a better message.
    std::error_code error;
    fs::path resolved = target;
    constexpr int k_max_links = 40;  // as many as Linux follows
    for (int links = 0; fs::is_symlink(fs::symlink_status(resolved, error)); ++links) {
        if (links == k_max_links) fail(target, "its symbolic links form a loop");
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

/// Creates the folders of this path that do not exist, and lists them.
std::error_code make_folders(const fs::path& folder, std::vector<fs::path>& made) {
    std::error_code error;
    if (folder.empty() || fs::exists(folder, error)) return {};
    if (const std::error_code above = make_folders(folder.parent_path(), made)) return above;
    if (fs::create_directory(folder, error)) made.push_back(folder);
    return error;
}

/// The prefix of the names of this machine's temporary files. Folders may be shared with other
/// machines, whose locks are not visible everywhere.
std::string temporary_prefix() {
    std::array<char, 65> host{};
    ::gethostname(host.data(), host.size() - 1);
    return fmt::format("{}{}-", k_prefix, host.data());
}

/// Removes a file that nobody has locked.
void remove_unlocked(const fs::path& file) {
    const int opened = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (opened < 0) return;
    if (::flock(opened, LOCK_EX | LOCK_NB) == 0) ::unlink(file.c_str());
    ::close(opened);
}

}  // namespace

void AtomicFile::remove_left_overs(const fs::path& folder, bool of_others_too) {
    std::error_code error;
    const std::string own = temporary_prefix();
    fs::directory_iterator entry(folder.empty() ? "." : folder, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (!name.starts_with(k_prefix) || !name.ends_with(".tmp")) continue;
        std::error_code ignored;
        if (name.starts_with(own))
            remove_unlocked(entry->path());
        else if (of_others_too)
            fs::remove(entry->path(), ignored);
    }
}

AtomicFile::AtomicFile(const fs::path& target, ReadTarget read_target)
    : read_target_(read_target), target_(checked(target)) {
    refuse_input(target);
    const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
    if (const int error = create_in(folder); error != 0) {
        remove_folders();
        fail(target_, why_not_created(folder, error));
    }
}

int AtomicFile::create_in(const fs::path& folder) {
    if (const std::error_code error = make_folders(folder, made_folders_)) return error.value();
    static std::atomic<unsigned> counter{0};
    // The process id alone is not unique among machines that share a folder; O_EXCL is.
    constexpr int k_attempts = 1000;
    const std::string prefix = temporary_prefix();
    int error = EEXIST;
    for (int attempt = 0; attempt < k_attempts && error == EEXIST; ++attempt) {
        temporary_ = folder / fmt::format("{}{}-{}.tmp", prefix, ::getpid(), counter++);
        lock_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (lock_ < 0) {
            error = errno;
            continue;
        }
        // Without locks nobody removes it either. A file that was removed just before it was locked
        // is made again.
        ::flock(lock_, LOCK_EX);
        struct stat status {};
        if (::fstat(lock_, &status) == 0 && status.st_nlink > 0) return 0;
        ::close(lock_);
        lock_ = -1;
    }
    return error;
}

AtomicFile::~AtomicFile() {
    if (lock_ >= 0) ::close(lock_);
    if (temporary_.empty()) return;
    std::error_code ignored;
    fs::remove(temporary_, ignored);
    remove_folders();
}

void AtomicFile::remove_folders() const {
    // Folders that contain something else by now are kept.
    std::error_code ignored;
    for (auto folder = made_folders_.rbegin(); folder != made_folders_.rend(); ++folder)
        fs::remove(*folder, ignored);
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

// Otherwise the rename may reach the disk before the contents, and a power cut would lose both.
void AtomicFile::write_through() const {
    if (::fsync(lock_) == 0) return;
    // Some file systems do not support it.
    if (errno == EINVAL || errno == ENOSYS || errno == ENOTSUP) return;
    fail(target_, std::generic_category().message(errno));
}

void AtomicFile::commit() {
    refuse_input(target_);  // it may have been read in the meantime
    if (read_target_ == ReadTarget::replace) keep_permissions();
    std::error_code error;
    if (fs::exists(target_, error)) write_through();
    fs::rename(temporary_, target_, error);
    if (error) fail(target_, error.message());
    temporary_.clear();
}

OutputFile::OutputFile(const std::filesystem::path& file)
    : file_(file), atomic_(file), stream_(atomic_.temporary_path(), std::ios::binary) {}

void OutputFile::write(std::span<const std::byte> bytes) {
    stream_.write(reinterpret_cast<const char*>(bytes.data()),
                  static_cast<std::streamsize>(bytes.size()));
    position_ += bytes.size();
}

void OutputFile::seek(std::uint64_t position) {
    stream_.seekp(static_cast<std::streamoff>(position));
    position_ = position;
}

void OutputFile::complete() {
    if (stream_.is_open()) stream_.close();
    if (!stream_)
        throw IoError(fmt::format(
            "{}: cannot write: some of the data was rejected; is the disk full?", file_.string()));
}

void OutputFile::commit() {
    complete();
    atomic_.commit();
}

OutputGroup::~OutputGroup() {
    while (!files_.empty()) files_.pop_back();
}

OutputFile& OutputGroup::add(const std::filesystem::path& file) {
    return *files_.emplace_back(std::make_unique<OutputFile>(file));
}

void OutputGroup::commit() {
    for (const auto& file : files_) file->complete();
    for (const auto& file : files_) file->commit();
    files_.clear();
}

FolderLock::FolderLock(const std::filesystem::path& folder) {
    std::error_code error;
    for (std::filesystem::path missing = folder;
         !missing.empty() && !std::filesystem::exists(missing, error);
         missing = missing.parent_path())
        made_.push_back(missing);
    if (!made_.empty()) std::filesystem::create_directories(folder, error);
    folder_ = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder_ >= 0) ::flock(folder_, LOCK_EX);
}

FolderLock::~FolderLock() {
    std::error_code ignored;
    for (const std::filesystem::path& folder : made_) std::filesystem::remove(folder, ignored);
    if (folder_ >= 0) ::close(folder_);
}

ScratchFolder::ScratchFolder() {
    std::error_code error;
    const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
    std::string name = (parent / "uwvdb-XXXXXX").string();
    if (error || mkdtemp(name.data()) == nullptr)
        throw IoError(name + ": cannot make a temporary folder; set TMPDIR to a writable one");
    path_ = name;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace uw
