#include "edit/session/file_watch.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <utility>

namespace uw {

namespace {

// A file is written in several steps: it is looked at once nothing has happened for so long [ms].
constexpr int k_settle = 50;

}  // namespace

FileWatch::FileWatch(const std::filesystem::path& folder, std::function<void()> changed)
    : changed_(std::move(changed)),
      notified_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)),
      stop_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    // Where there are no watches left, files are compared when they are saved, all the same.
    inotify_add_watch(notified_, folder.c_str(),
                      IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE);
    thread_ = std::thread([this] { run(); });
}

FileWatch::~FileWatch() {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(stop_, &one, sizeof one);
    thread_.join();
    if (notified_ >= 0) close(notified_);
    close(stop_);
}

void FileWatch::run() const {
    std::array<pollfd, 2> polled{{{stop_, POLLIN, 0}, {notified_, POLLIN, 0}}};
    std::array<char, 4096> ignored{};
    bool is_news = false;
    for (;;) {
        const int count = poll(polled.data(), polled.size(), is_news ? k_settle : -1);
        if (polled[0].revents != 0) return;
        if (count == 0 && std::exchange(is_news, false)) changed_();
        while (read(notified_, ignored.data(), ignored.size()) > 0) is_news = true;
    }
}

}  // namespace uw
