#include "core/base/input_files.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

namespace {

struct Place {
    std::size_t length = 0;  // of the pattern
    int digits = 0;          // at least
};

// Removes "0N", N of one or two digits, from the beginning of `text`.
std::optional<int> take_width(std::string_view& text) {
    if (!text.starts_with('0')) return std::nullopt;
    int width = 0;
    std::size_t length = 1;
    while (length < std::min<std::size_t>(text.size(), 3) && is_digit(text[length]))
        width = 10 * width + (text[length++] - '0');
    if (length == 1) return std::nullopt;
    text.remove_prefix(length);
    return width;
}

// The pattern with which `text` begins.
std::optional<Place> place_at(std::string_view text) {
    std::string_view rest = text;
    const auto place = [&](int digits) { return Place{text.size() - rest.size(), digits}; };
    if (take_beginning(rest, "#")) {
        while (take_beginning(rest, "#")) {
        }
        return place(static_cast<int>(text.size() - rest.size()));
    }
    if (take_beginning(rest, "%")) {
        const int digits = take_width(rest).value_or(0);
        if (take_beginning(rest, "d")) return place(digits);
        return std::nullopt;
    }
    if (take_beginning(rest, "$F")) {
        int digits = 0;
        if (!rest.empty() && is_digit(rest.front()) && rest.front() != '0') {
            digits = rest.front() - '0';
            rest.remove_prefix(1);
        }
        const bool goes_on =
            !rest.empty() && std::isalnum(static_cast<unsigned char>(rest.front())) != 0;
        if (goes_on) return std::nullopt;
        return place(digits);
    }
    if (take_beginning(rest, "{frame")) {
        int digits = 0;
        if (take_beginning(rest, ":")) {
            digits = take_width(rest).value_or(0);
            take_beginning(rest, "d");
        }
        if (take_beginning(rest, "}")) return place(digits);
    }
    return std::nullopt;
}

}  // namespace

bool has_frame_pattern(std::string_view name) {
    for (; !name.empty(); name.remove_prefix(1))
        if (place_at(name)) return true;
    return false;
}

std::string expand_frame_pattern(std::string_view name, int frame) {
    std::string result;
    while (!name.empty()) {
        if (const auto place = place_at(name)) {
            result += fmt::format("{:0{}d}", frame, std::max(place->digits, 1));
            name.remove_prefix(place->length);
        } else {
            result += name.front();
            name.remove_prefix(1);
        }
    }
    return result;
}

std::filesystem::path file_of_frame(const std::filesystem::path& name, int frame) {
    std::filesystem::path file;
    for (auto part = name.begin(); part != name.end(); ++part) {
        std::error_code ignored;
        const bool is_last = std::next(part) == name.end();
        if (!is_last && std::filesystem::is_directory(file / *part, ignored))
            file /= *part;
        else
            file /= expand_frame_pattern(part->string(), frame);
    }
    return file;
}

std::vector<int> frames_found(const std::filesystem::path& name) {
    const std::filesystem::path folder = name.parent_path().empty() ? "." : name.parent_path();
    const std::string pattern = name.filename().string();
    std::set<int> frames;
    std::error_code error;
    std::filesystem::directory_iterator entry(folder, error);
    for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        const std::string file = entry->path().filename().string();
        // Any run of digits may be the number; the right one reproduces the name.
        for (std::size_t at = 0; at < file.size(); ++at) {
            if (!is_digit(file[at]) || (at > 0 && is_digit(file[at - 1]))) continue;
            int number = 0;
            const char* const end = file.data() + file.size();
            if (std::from_chars(file.data() + at, end, number).ec != std::errc()) continue;
            if (expand_frame_pattern(pattern, number) == file) frames.insert(number);
        }
    }
    return {frames.begin(), frames.end()};
}

bool differs_by_frame(const std::filesystem::path& name) {
    return file_of_frame(name, 0) != file_of_frame(name, 1);
}

namespace {

namespace fs = std::filesystem;

constexpr const char* k_lfs =
    "is a Git LFS pointer, not the file itself; fetch its content with 'git lfs pull'";
constexpr const char* k_annex =
    "is a git-annex pointer, not the file itself; fetch its content with 'git annex get'";

}  // namespace

std::string stand_in_of(const fs::path& file) {
    std::error_code error;
    if (fs::is_symlink(file, error) && !fs::exists(file, error) &&
        fs::read_symlink(file, error).generic_string().find("annex/objects/") != std::string::npos)
        return k_annex;
    if (!fs::is_regular_file(file, error)) return "";
    std::string beginning(256, '\0');
    std::ifstream in = open_own_file(file);
    in.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
    beginning.resize(static_cast<std::size_t>(in.gcount()));
    if (beginning.starts_with("version https://git-lfs.github.com/spec/") ||
        beginning.starts_with("version https://hawser.github.com/spec/"))
        return k_lfs;
    // An unlocked file's pointer, or a link where the file system has none.
    const std::string_view line = std::string_view(beginning).substr(0, beginning.find('\n'));
    const bool is_text = line.find('\0') == std::string_view::npos;
    if (is_text && (line.starts_with("/annex/objects/") ||
                    line.find(".git/annex/objects/") != std::string_view::npos))
        return k_annex;
    return "";
}

namespace {

using Identity = std::pair<dev_t, ino_t>;

Identity identity_of(const FileStamp& stamp) {
    return {stamp.device, stamp.number};
}

struct Input {
    fs::path file;  // absolute
    FileStamp stamp;
};

/// The inputs of the whole program: no part of it may replace a file that another part reads.
struct Registry {
    std::mutex mutex;
    std::multimap<Identity, Input> inputs;
    bool is_confined = false;
    std::optional<fs::path> confines;  // once an input was named
};

Registry& registry() {
    static Registry all;
    return all;
}

/// Both are canonical.
bool lies_in(const fs::path& folder, const fs::path& file) {
    return std::ranges::mismatch(folder, file).in1 == folder.end();
}

// Precondition: the registry is locked.
void check_confines(const fs::path& file, Registry& all) {
    if (!all.is_confined) return;
    std::error_code error;
    const fs::path place = fs::weakly_canonical(file, error);
    if (!all.confines) all.confines = place.parent_path();
    const fs::path& folder = *all.confines;
    if (lies_within(folder, file)) return;
    throw InputError(fmt::format("{}: lies outside '{}', to which --confine keeps what is read",
                                 printable(file.string()), printable(folder.string())));
}

bool is_as_old(const FileStamp& a, const FileStamp& b) {
    return a.modified_s == b.modified_s && a.modified_ns == b.modified_ns;
}

}  // namespace

bool lies_within(const fs::path& folder, const fs::path& file) {
    std::error_code error, folder_error;
    const fs::path place = fs::weakly_canonical(file, error);
    const fs::path root = fs::weakly_canonical(folder, folder_error);
    if (error || folder_error || !lies_in(root, place)) return false;
    fs::path partial_path;
    for (const fs::path& part : file) {
        partial_path /= part;
        if (fs::is_symlink(fs::symlink_status(partial_path, error)) &&
            !fs::exists(partial_path, error))
            return false;
    }
    return true;
}

std::optional<FileStamp> stamp_of(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return std::nullopt;
    return FileStamp{status.st_dev, status.st_ino, static_cast<std::uint64_t>(status.st_size),
                     status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

FileStamps::FileStamps(const std::vector<fs::path>& files) {
    for (const fs::path& file : files) stamps_.emplace_back(file, stamp_of(file));
}

void FileStamps::add(const FileStamps& other) {
    stamps_.insert(stamps_.end(), other.stamps_.begin(), other.stamps_.end());
}

bool FileStamps::are_current() const {
    return std::ranges::all_of(stamps_,
                               [](const auto& of) { return stamp_of(of.first) == of.second; });
}

void confine_inputs() {
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    all.is_confined = true;
}

bool inputs_are_confined() {
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    return all.is_confined;
}

void remember_input(const fs::path& file) {
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    const std::optional<FileStamp> stamp = stamp_of(file);
    if (!stamp) return;
    std::error_code error;
    fs::path absolute = fs::absolute(file, error);
    if (error) absolute = file;
    const auto [begin, end] = all.inputs.equal_range(identity_of(*stamp));
    for (auto input = begin; input != end; ++input) {
        if (input->second.file != absolute) continue;
        input->second.stamp = *stamp;
        return;
    }
    all.inputs.emplace(identity_of(*stamp), Input{std::move(absolute), *stamp});
}

namespace {

/// Throws IoError unless `file` is a regular one, or a pipe where these are read.
void check_kind(const fs::path& file, const std::string& subject, std::string_view noun,
                Pipes pipes) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    const auto fail = [&](const std::string& what) {
        throw IoError(fmt::format("{}: {}", subject, what));
    };
    switch (status.type()) {
        case fs::file_type::regular:
            return;
        case fs::file_type::not_found:
            return fail(fmt::format("no such file; check the name of the {}", noun));
        case fs::file_type::directory:
            return fail(fmt::format("is a folder; name the {} in it", noun));
        case fs::file_type::character:
        case fs::file_type::block:
            return fail(fmt::format("is a device; name the {}", noun));
        case fs::file_type::fifo:
            if (pipes == Pipes::read) return;
            return fail(fmt::format("is a pipe; name the {}", noun));
        case fs::file_type::none:
            return fail("cannot be read; check its permissions");
        default:
            return fail(fmt::format("is no file that can be read; name the {}", noun));
    }
}

void admit(const fs::path& file, const std::string& subject, std::string_view noun,
           NamedBy named_by, Pipes pipes) {
    if (named_by == NamedBy::scene) {
        Registry& all = registry();
        const std::lock_guard lock(all.mutex);
        check_confines(file, all);
    }
    check_kind(file, subject, noun, pipes);
    remember_input(file);
}

}  // namespace

void admit_input(const fs::path& file, const std::string& subject, std::string_view noun,
                 NamedBy named_by) {
    admit(file, subject, noun, named_by, Pipes::refused);
}

std::ifstream open_input(const fs::path& file, const std::string& subject, std::string_view noun) {
    admit_input(file, subject, noun);
    std::ifstream in(file, std::ios::binary);
    if (!in) throw IoError(fmt::format("{}: cannot be read; check its permissions", subject));
    return in;
}

std::ifstream open_own_file(const fs::path& file) {
    std::error_code error;
    std::ifstream in;
    if (fs::is_regular_file(file, error))
        in.open(file, std::ios::binary);
    else
        in.setstate(std::ios::failbit);
    return in;
}

std::vector<fs::path> inputs_outside(const fs::path& folder) {
    std::error_code error;
    const fs::path place = fs::weakly_canonical(folder, error);
    std::vector<fs::path> outside;
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    for (const auto& [identity, input] : all.inputs) {
        const fs::path file = fs::weakly_canonical(input.file, error);
        if (!lies_in(place, error ? input.file : file))
            outside.push_back(error ? input.file : file);
    }
    std::ranges::sort(outside);
    outside.erase(std::unique(outside.begin(), outside.end()), outside.end());
    return outside;
}

// A file that was deleted may have left its number to another one: that is not an input unless it
// is as old as the input was, or has its name.
bool is_input(const fs::path& file) {
    const std::optional<FileStamp> stamp = stamp_of(file);
    if (!stamp) return false;
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    const auto [begin, end] = all.inputs.equal_range(identity_of(*stamp));
    for (auto input = begin; input != end; ++input) {
        if (is_as_old(input->second.stamp, *stamp)) return true;
        const std::optional<FileStamp> now = stamp_of(input->second.file);
        if (now && identity_of(*now) == identity_of(*stamp)) return true;
    }
    return false;
}

bool is_file(const fs::path& file) {
    std::error_code ignored;
    return fs::is_regular_file(file, ignored);
}

namespace {

// Files are read in parts, each as long as all previous ones together.
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
    OpenFile(OpenFile&&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    OpenFile& operator=(OpenFile&&) = delete;

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

namespace {

/// A format that is taken for a scene by mistake.
struct OtherFormat {
    std::string_view name;
    std::string_view beginning;  // of its files; empty: not known by it
    std::string_view endings;    // of their names, each followed by a blank
    std::string_view hint;       // {}: the file's name
};

constexpr std::string_view k_show_volume =
    "a scene that shows it is written by: uwvdb info '{}' --scene > scene.yaml";
constexpr std::string_view k_export_surfaces =
    "export its surfaces, lamps and camera as glTF (.glb), and name that in a scene: geometry: "
    "[{{file: x.glb}}]";
constexpr std::string_view k_name_scene = "name the scene, a YAML file";
constexpr auto k_other_formats = std::to_array<OtherFormat>({
    {"a VDB volume", std::string_view(" BDV\0\0\0\0", 8), ".vdb ", k_show_volume},
    {"a NanoVDB volume", "NanoVDB", ".nvdb ", k_show_volume},
    {"a Blender file", "BLENDER", ".blend ", k_export_surfaces},
    {"a glTF file", "glTF", ".glb .gltf ",
     "name it in a scene: geometry: [{{file: {}}}], with camera: true and lamps: true for its own"},
    {"an FBX file", "Kaydara FBX", ".fbx ", k_export_surfaces},
    {"a USD file", "PXR-USDC", ".usd .usdc .usdz ", k_export_surfaces},
    {"an OpenEXR image", "\x76\x2f\x31\x01", ".exr ", k_name_scene},
    {"a PNG image", "\x89PNG", ".png ", k_name_scene},
    {"a JPEG image", "\xff\xd8\xff", ".jpg .jpeg ", k_name_scene},
});

}  // namespace

std::string other_format(std::string_view bytes, const std::filesystem::path& file,
                         std::string_view noun) {
    const std::string ending = lower_case(file.extension().string()) + " ";
    const auto find = [](const auto& is_it) {
        return std::ranges::find_if(k_other_formats, is_it);
    };
    auto format = find(
        [&](const OtherFormat& f) { return !bytes.empty() && bytes.starts_with(f.beginning); });
    if (format == k_other_formats.end() && ending.size() > 1)
        format = find(
            [&](const OtherFormat& f) { return f.endings.find(ending) != std::string_view::npos; });
    if (format == k_other_formats.end()) return "";
    const std::string name = printable(file.string(), 300);
    return fmt::format("is {}, not a valid {}; {}", format->name, noun,
                       noun == "scene" ? fmt::format(fmt::runtime(format->hint), name)
                                       : fmt::format("name the {}", noun));
}

std::string read_text_file(const std::filesystem::path& file, const std::string& subject,
                           std::size_t max_bytes, std::string_view noun, Pipes pipes) {
    admit(file, subject, noun, NamedBy::scene, pipes);
    const OpenFile open(file);
    std::string text;
    ::ssize_t count = 1;
    while (count > 0 && text.size() <= max_bytes) {
        const std::size_t had = text.size();
        text.resize(std::min(had + std::max(had, k_first_part), max_bytes + 1));
        count = open.read(&text[had], text.size() - had);
        text.resize(had + static_cast<std::size_t>(std::max<::ssize_t>(count, 0)));
    }
    if (count < 0) throw IoError(fmt::format("{}: cannot be read; check its permissions", subject));
    if (text.size() > max_bytes) {
        if (const std::string other = other_format(text, file, noun); !other.empty())
            throw InputError(fmt::format("{}: {}", subject, other));
        throw InputError(fmt::format("{}: is larger than {} MiB; this is not a valid {}", subject,
                                     max_bytes >> 20, noun));
    }
    return text;
}

}  // namespace uw
