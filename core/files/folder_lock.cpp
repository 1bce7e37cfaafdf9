#include "core/files/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <system_error>

namespace uw {

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

}  // namespace uw
