#pragma once

#include <filesystem>

namespace uw {

/// Writes a file so that its name only ever holds a whole one: write to `temporary_path`, beside
/// the target, then `commit`. What is not committed is removed.
/// Making one and dropping it tells, before any work is done, whether the target can be written.
class AtomicFile {
  public:
    /// Creates the empty temporary file. A target that is a symbolic link is written through.
    /// Throws IoError if that is not possible: folder missing, not writable, or the target is a
    /// folder or a device.
    explicit AtomicFile(const std::filesystem::path& target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    AtomicFile(AtomicFile&&) = delete;
    AtomicFile& operator=(AtomicFile&&) = delete;

    const std::filesystem::path& temporary_path() const { return temporary_; }

    /// Gives the temporary file the target's name, replacing what had it. Throws IoError.
    void commit();

  private:
    std::filesystem::path target_;
    std::filesystem::path temporary_;
};

}  // namespace uw
