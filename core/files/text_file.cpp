#include "core/files/text_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "core/base/error.h"
#include "core/files/input_files.h"

namespace uw {

namespace {

// Files are read in parts, each as long as all before.
constexpr std::size_t k_first_part = std::size_t{1} << 18;

/// A file open for reading. Opening a pipe does not wait for somebody to write to it: without a
/// writer it is empty.
class OpenFile {
  public:
    explicit OpenFile(const std::filesystem::path& file)
        : descriptor_(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
    ~OpenFile() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    /// The number of bytes read, 0 at the end; negative: it cannot be read.
    ::ssize_t read(char* to, std::size_t most) const {
        while (true) {
            const ::ssize_t count = ::read(descriptor_, to, most);
            if (count >= 0 || (errno != EAGAIN && errno != EINTR)) return count;
            ::pollfd more{descriptor_, POLLIN, 0};
            ::poll(&more, 1, -1);
        }
    }

  private:
    int descriptor_;
};

}  // namespace

std::string read_text_file(const std::filesystem::path& file, const std::string& subject,
                           std::size_t most_bytes, std::string_view noun) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found)
        throw IoError(fmt::format("{}: no such file; check the name of the {}", subject, noun));
    if (std::filesystem::is_directory(status))
        throw IoError(fmt::format("{}: is a folder; name the {} in it", subject, noun));
    if (std::filesystem::is_character_file(status) || std::filesystem::is_block_file(status))
        throw IoError(fmt::format("{}: is a device; name the {}", subject, noun));
    remember_input(file);
    const OpenFile open(file);
    std::string text;
    ::ssize_t count = 1;
    while (count > 0 && text.size() <= most_bytes) {
        const std::size_t had = text.size();
        text.resize(std::min(had + std::max(had, k_first_part), most_bytes + 1));
        count = open.read(&text[had], text.size() - had);
        text.resize(had + static_cast<std::size_t>(std::max<::ssize_t>(count, 0)));
    }
    if (count < 0) throw IoError(fmt::format("{}: cannot be read; check its permissions", subject));
    if (text.size() > most_bytes)
        throw InputError(fmt::format("{}: is larger than {} MiB; this is not a valid {}", subject,
                                     most_bytes >> 20, noun));
    return text;
}

}  // namespace uw
