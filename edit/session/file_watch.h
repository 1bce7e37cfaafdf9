#pragma once

#include <filesystem>
#include <functional>
#include <thread>

namespace uw {

/// Calls back, on a thread of its own, shortly after a file of a folder was written, replaced or
/// removed. Costs nothing meanwhile.
class FileWatch {
  public:
    FileWatch(const std::filesystem::path& folder, std::function<void()> changed);
    ~FileWatch();
    FileWatch(const FileWatch&) = delete;
    FileWatch& operator=(const FileWatch&) = delete;
    FileWatch(FileWatch&&) = delete;
    FileWatch& operator=(FileWatch&&) = delete;

  private:
    void run() const;

    std::function<void()> changed_;
    int notified_ = -1, stop_ = -1;
    std::thread thread_;
};

}  // namespace uw
