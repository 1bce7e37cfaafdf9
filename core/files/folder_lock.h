#pragma once

#include <filesystem>
#include <vector>

namespace uw {

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

}  // namespace uw
