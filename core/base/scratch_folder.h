#pragma once

#include <filesystem>

namespace uw {

/// A new folder for files of the moment; it goes with everything in it when the object does.
class ScratchFolder {
  public:
    /// Throws IoError if none can be made.
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
