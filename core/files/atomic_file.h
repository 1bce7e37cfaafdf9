#pragma once

#include <filesystem>
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

    /// Removes what runs on this machine that were killed left in `folder`: temporary files that
    /// nobody is writing any more. `of_others_too`: and those of other machines that share it,
    /// of which that cannot be known.
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

}  // namespace uw
