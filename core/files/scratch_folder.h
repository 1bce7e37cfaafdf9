#pragma once

#include <filesystem>

namespace uw {

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
