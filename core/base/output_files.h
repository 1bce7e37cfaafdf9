#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace uw {

/// What to do with a target that the program has read (remember_input): outputs never replace such
/// a file; a document that its user has changed and saves is the next version of it, and keeps its
/// permissions.
enum class ReadTarget { refuse, replace };

/// Writes a file such that its name only ever refers to a complete one: write to `temporary_path`,
/// beside the target, then `commit`. A file that is not committed is removed, and so are the
/// folders that were made for it. Constructing and destroying one checks, before any work is done,
/// whether the target can be written.
class AtomicFile {
  public:
    /// Creates the empty temporary file, and the folders that it is to be in. A target that is a
    /// symbolic link is written through. Throws IoError if this is impossible: the folder is not
    /// writable, or the target is a folder, a device, or a file that `read_target` refuses.
    explicit AtomicFile(const std::filesystem::path& target,
                        ReadTarget read_target = ReadTarget::refuse);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    AtomicFile(AtomicFile&&) = delete;
    AtomicFile& operator=(AtomicFile&&) = delete;

    const std::filesystem::path& temporary_path() const { return temporary_; }

    /// Removes the temporary files in `folder` that killed runs on this machine left behind, which
    /// nobody is writing any more. `of_others_too`: also those of other machines that share the
    /// folder, whose runs may still be active.
    static void remove_left_overs(const std::filesystem::path& folder, bool of_others_too = false);

    /// Renames the temporary file to the target, replacing any existing file, which is there until
    /// the new one is on the disk, whatever happens to the machine. Throws IoError.
    void commit();

  private:
    void refuse_input(const std::filesystem::path& name) const;
    /// Creates the temporary file; the error's number if it cannot be, else 0.
    int create_in(const std::filesystem::path& folder);
    void remove_folders() const;
    void keep_permissions() const;
    /// Waits until what was written is on the disk.
    void write_through() const;

    ReadTarget read_target_;
    std::filesystem::path target_;
    std::filesystem::path temporary_;
    int lock_ = -1;                                    // held on it, open, as long as it is written
    std::vector<std::filesystem::path> made_folders_;  // outermost first
};

/// A binary file that appears under its name only once it is complete: write, then commit. If any
/// of it cannot be written, commit() throws, but no earlier call does.
class OutputFile {
  public:
    /// Throws as AtomicFile's constructor.
    explicit OutputFile(const std::filesystem::path& file);

    void write(std::span<const std::byte> bytes);
    void write(std::string_view bytes) { write(std::as_bytes(std::span(bytes))); }
    /// Where the next bytes go, from the beginning of the file.
    std::uint64_t position() const { return position_; }
    void seek(std::uint64_t position);

    const std::filesystem::path& path() const { return file_; }

    /// Throws IoError unless the file is complete; it bears its name once it is committed.
    void complete();
    /// Throws IoError unless the file is complete and bears its name.
    void commit();

  private:
    std::filesystem::path file_;
    AtomicFile atomic_;
    std::ofstream stream_;
    std::uint64_t position_ = 0;
};

/// Files that belong together: none appears under its name before all of them are complete.
class OutputGroup {
  public:
    OutputGroup() = default;
    /// Folders that were made for files that are not committed are removed with the first of them.
    ~OutputGroup();
    OutputGroup(const OutputGroup&) = delete;
    OutputGroup& operator=(const OutputGroup&) = delete;
    OutputGroup(OutputGroup&&) = default;
    OutputGroup& operator=(OutputGroup&&) = default;

    /// A file of the group, as long as that lives. Throws as AtomicFile's constructor.
    OutputFile& add(const std::filesystem::path& file);

    /// Throws IoError unless all files are complete and bear their names.
    void commit();

  private:
    std::vector<std::unique_ptr<OutputFile>> files_;
};

/// As long as it lives, another process that locks the same folder waits: files that belong
/// together are replaced together, or not at all. A folder that does not exist is made; it stays if
/// it is filled meanwhile. No lock outlives its process. Where folders cannot be locked it does
/// nothing.
class FolderLock {
  public:
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;
    FolderLock(FolderLock&&) = delete;
    FolderLock& operator=(FolderLock&&) = delete;

  private:
    int folder_;
    std::vector<std::filesystem::path> made_;  // innermost first
};

/// A new folder for temporary files; it is removed with all its contents when the object is
/// destroyed.
class ScratchFolder {
  public:
    /// Throws IoError if it cannot be created.
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ScratchFolder(ScratchFolder&&) = delete;
    ScratchFolder& operator=(ScratchFolder&&) = delete;

    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace uw
