#include "core/scene/pose_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/json.h"
#include "core/base/text.h"
#include "core/scene/yaml_document.h"

namespace uw {

namespace {

/// One line of a file of poses, for messages.
struct PoseLine {
    const std::string& origin;  // the scene entry and the file
    std::size_t number = 0;     // from 1

    /// Throws InputError "<origin>:<number>: <what>".
    [[noreturn]] void fail(const std::string& what) const;
    /// A finite number; `name` is the column's.
    double parsed(std::string_view cell, std::string_view name) const;
    /// A time to the nearest nanosecond [ns]; its unit is 10^places ns. `expected` describes the
    /// number; `hint` says what a number that is too large for a time may be instead.
    std::int64_t stamp(std::string_view cell, int places, std::string_view expected,
                       std::string_view hint) const;
    /// The rotation of a quaternion of length 1 to within 1e-3.
    Rotation rotation(double w, double x, double y, double z) const;
};

/// The largest number in a file of poses.
constexpr double k_max_pose_number = 1e12;

/// The last time of a file of poses, in the year 2116: differences of two fit into 64 bits [ns].
constexpr std::int64_t k_last_stamp = std::int64_t{1} << 62;

/// A decimal number in units of 10^-places, rounded to the nearest whole one. 64 bits are exact
/// where a double is not: for the nanoseconds of a clock that began in 1970. None beyond
/// k_last_stamp. Precondition: parse_number reads it.
std::optional<std::int64_t> decimal_in_units(std::string_view text, int places) {
    const bool is_negative = text.starts_with('-');
    if (is_negative || text.starts_with('+')) text.remove_prefix(1);
    constexpr int k_no_power = 1000;  // of a double
    int power = places;
    const std::size_t end = std::min(text.find_first_of("eE"), text.size());
    if (end < text.size()) {
        std::string_view exponent = text.substr(end + 1);
        if (exponent.starts_with('+')) exponent.remove_prefix(1);
        int given = exponent.starts_with('-') ? -k_no_power : k_no_power;
        std::from_chars(exponent.data(), exponent.data() + exponent.size(), given);
        power += std::clamp(given, -k_no_power, k_no_power);
    }
    std::string digits;
    bool is_fraction = false;
    for (const char c : text.substr(0, end)) {
        if (c == '.') {
            is_fraction = true;
            continue;
        }
        digits += c;
        if (is_fraction) --power;
    }
    digits.erase(0, digits.find_first_not_of('0'));
    if (digits.empty()) return 0;
    std::uint64_t units = 0;
    bool rounds_up = false;
    constexpr int k_max_digits = 19;
    const int kept = static_cast<int>(digits.size()) + power;
    if (kept > k_max_digits) return std::nullopt;
    if (power > 0) digits.append(static_cast<std::size_t>(power), '0');
    if (power < 0 && kept >= 0) rounds_up = digits[static_cast<std::size_t>(kept)] >= '5';
    if (power < 0) digits.resize(static_cast<std::size_t>(std::max(kept, 0)));
    std::from_chars(digits.data(), digits.data() + digits.size(), units);
    if (rounds_up) ++units;
    if (units > static_cast<std::uint64_t>(k_last_stamp)) return std::nullopt;
    const auto magnitude = static_cast<std::int64_t>(units);
    return is_negative ? -magnitude : magnitude;
}

// Files have four digits and more.
constexpr double k_unit_tolerance = 1e-3;
constexpr double k_last_frame = 999'999'999;
constexpr int k_places_of_seconds = 9;    // of a nanosecond
constexpr double k_exact_whole = 0x1p53;  // above it all doubles are whole

/// From one time of a clock to another [s].
double seconds_between(std::int64_t from, std::int64_t to) {
    return static_cast<double>(to - from) / 1e9;
}

/// The number at the end of an image's name, and what is before it.
struct NumberedName {
    std::string_view stem;
    double number = 0;
};

std::optional<NumberedName> numbered(std::string_view name) {
    const std::size_t folder = name.find_last_of('/');
    const std::size_t dot = name.find_last_of('.');
    if (dot != std::string_view::npos && (folder == std::string_view::npos || dot > folder))
        name = name.substr(0, dot);
    std::size_t digits = name.size();
    while (digits > 0 && name[digits - 1] >= '0' && name[digits - 1] <= '9') --digits;
    NumberedName result{name.substr(0, digits)};
    if (parse_number(name.substr(digits), result.number) != NumberText::number ||
        result.number > k_last_frame)
        return std::nullopt;
    return result;
}

/// Sets the times to the numbers in the names, if these differ in nothing else.
bool number_by_names(const std::vector<NamedPose>& named, std::vector<TimedPose>& poses) {
    std::optional<std::string_view> stem;
    for (std::size_t i = 0; i < named.size(); ++i) {
        const auto name = numbered(named[i].name);
        if (!name || (stem && *stem != name->stem)) return false;
        stem = name->stem;
        poses[i].time = name->number;
    }
    std::ranges::sort(poses, {}, &TimedPose::time);
    return std::ranges::adjacent_find(poses, {}, &TimedPose::time) == poses.end();
}

void PoseLine::fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", origin, number, what));
}

double PoseLine::parsed(std::string_view cell, std::string_view name) const {
    double value = 0;
    if (parse_number(cell, value) != NumberText::number || std::abs(value) > k_max_pose_number)
        fail(fmt::format("{}: expected a number of at most 1e12, found '{}'", name,
                         printable(cell)));
    return value;
}

std::int64_t PoseLine::stamp(std::string_view cell, int places, std::string_view expected,
                             std::string_view hint) const {
    double value = 0;
    const bool is_number = parse_number(cell, value) == NumberText::number;
    const auto units = is_number ? decimal_in_units(cell, places) : std::nullopt;
    if (!units)
        fail(fmt::format("{}, found '{}'{}{}", expected, printable(cell),
                         is_number ? ", which is after the year 2116" : "", is_number ? hint : ""));
    return *units;
}

Rotation PoseLine::rotation(double w, double x, double y, double z) const {
    const double length = std::sqrt(w * w + x * x + y * y + z * z);
    if (!(std::abs(length - 1) <= k_unit_tolerance))
        fail(fmt::format("the quaternion has length {:.6g}, not 1; check the order of the columns",
                         length));
    return normalised({w, x, y, z});
}

/// Throws InputError for names that are the same.
void sort_by_name(std::vector<NamedPose>& named, const std::string& origin) {
    std::ranges::sort(named, {}, &NamedPose::name);
    const auto twin = std::ranges::adjacent_find(named, {}, &NamedPose::name);
    if (twin != named.end())
        PoseLine{origin, std::max(twin->line, (twin + 1)->line)}.fail(fmt::format(
            "the image '{}' is there twice; give each its own name", printable(twin->name)));
}

/// The poses by frame (PoseFile::poses), of names in alphabetical order.
std::vector<TimedPose> by_frame(const std::vector<NamedPose>& named) {
    std::vector<TimedPose> poses;
    poses.reserve(named.size());
    for (const NamedPose& pose : named)
        poses.push_back({static_cast<double>(poses.size()), pose.pose});
    std::vector<TimedPose> by_number = poses;
    return number_by_names(named, by_number) ? by_number : poses;
}

/// The cells of a line, between blanks or, with one, a separator and blanks; at most `most`, the
/// last of which is then the rest of the line.
std::vector<std::string_view> cells_of(std::string_view line, std::string_view separators,
                                       std::size_t most = SIZE_MAX) {
    std::vector<std::string_view> cells;
    while (true) {
        const std::size_t first = line.find_first_not_of(separators);
        if (first == std::string_view::npos) return cells;
        line.remove_prefix(first);
        const std::size_t end = cells.size() + 1 == most
                                    ? line.size()
                                    : std::min(line.find_first_of(separators), line.size());
        cells.push_back(line.substr(0, end));
        line.remove_prefix(end);
    }
}

void check_count(const PoseLine& line, std::size_t poses) {
    if (poses >= k_max_poses)
        line.fail("the file has more than a million poses; give those that are needed");
}

/// Adds a pose at a time of the file's clock [ns], which must be after that before.
void add_pose(PoseFile& file, const PoseLine& line, std::int64_t stamp, const Pose& pose) {
    if (!file.stamps.empty() && stamp <= file.stamps.back())
        line.fail(stamp == file.stamps.back()
                      ? "has the time of the pose before, to the nanosecond; give each its own"
                      : "its time is before that of the pose before; sort the file by time");
    file.stamps.push_back(stamp);
    file.poses.push_back({seconds_between(file.stamps.front(), stamp), pose});
}

// The formats whose poses are lines of a table. `origin` names the scene entry and the file in
// messages.
PoseFile read_tum(std::string_view text, const std::string& origin) {
    PoseFile file;
    for (PoseLine line{origin, 1}; !text.empty(); ++line.number) {
        const std::string_view content = trimmed(take_line(text));
        if (content.empty() || content.front() == '#') continue;
        const std::vector<std::string_view> cells = cells_of(content, " \t,");
        constexpr std::array<std::string_view, 8> k_columns{"timestamp", "tx", "ty", "tz",
                                                            "qx",        "qy", "qz", "qw"};
        if (cells.size() != k_columns.size())
            line.fail(fmt::format("expected the 8 columns timestamp tx ty tz qx qy qz qw, found {}",
                                  cells.size()));
        check_count(line, file.poses.size());
        const std::int64_t stamp = line.stamp(
            cells[0], k_places_of_seconds, "timestamp: expected a number of seconds",
            "; divide times in nanoseconds by 1e9, or, if qw comes before qx, write format: euroc");
        std::array<double, 8> v{};
        for (std::size_t i = 1; i < v.size(); ++i) v[i] = line.parsed(cells[i], k_columns[i]);
        add_pose(file, line, stamp, {{v[1], v[2], v[3]}, line.rotation(v[7], v[4], v[5], v[6])});
    }
    return file;
}

PoseFile read_euroc(std::string_view text, const std::string& origin) {
    PoseFile file;
    for (PoseLine line{origin, 1}; !text.empty(); ++line.number) {
        const std::string_view content = trimmed(take_line(text));
        if (content.empty() || content.front() == '#') continue;
        const std::vector<std::string_view> cells = cells_of(content, " \t,");
        constexpr std::array<std::string_view, 8> k_columns{"time", "x",  "y",  "z",
                                                            "qw",   "qx", "qy", "qz"};
        if (cells.size() < k_columns.size())
            line.fail(
                fmt::format("expected the 8 columns ns, x, y, z, qw, qx, qy, qz or more, found {}",
                            cells.size()));
        check_count(line, file.poses.size());
        constexpr std::string_view k_expected = "expected the time in whole nanoseconds";
        const std::int64_t stamp = line.stamp(cells[0], 0, k_expected, "");
        // Tables that went through floating-point numbers have 1403636579763555584.0, or 1.4e18.
        double number = 0;
        parse_number(cells[0], number);
        if (std::abs(number) < k_exact_whole && number != std::round(number))
            line.fail(fmt::format(
                "{}, found '{}'; multiply times in seconds by 1e9, or, if qw comes last, write "
                "format: tum",
                k_expected, printable(cells[0])));
        std::array<double, 8> v{};
        for (std::size_t i = 1; i < v.size(); ++i) v[i] = line.parsed(cells[i], k_columns[i]);
        add_pose(file, line, stamp, {{v[1], v[2], v[3]}, line.rotation(v[4], v[5], v[6], v[7])});
    }
    return file;
}

std::vector<NamedPose> read_colmap_images(std::string_view text, const std::string& origin) {
    std::vector<NamedPose> named;
    for (PoseLine line{origin, 1}; !text.empty(); ++line.number) {
        const std::string_view content = trimmed(take_line(text));
        if (content.empty() || content.front() == '#') continue;
        constexpr std::array<std::string_view, 10> k_columns{
            "IMAGE_ID", "QW", "QX", "QY", "QZ", "TX", "TY", "TZ", "CAMERA_ID", "NAME"};
        const std::vector<std::string_view> cells = cells_of(content, " \t", k_columns.size());
        if (cells.size() != k_columns.size())
            line.fail(
                fmt::format("expected IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, found {} "
                            "columns; COLMAP's images.txt has two lines for each image",
                            cells.size()));
        check_count(line, named.size());
        std::array<double, 8> v{};
        for (std::size_t i = 1; i < v.size(); ++i) v[i] = line.parsed(cells[i], k_columns[i]);
        const Affine camera_from_world{line.rotation(v[1], v[2], v[3], v[4]).matrix(),
                                       Vector3(v[5], v[6], v[7])};
        named.push_back({std::string(cells[9]), pose_of(camera_from_world.inverse()), line.number});
        take_line(text);  // the points that it sees
        ++line.number;
    }
    return named;
}

/// Takes numbers and names from the beginning of COLMAP's binary files, which are little-endian.
class ColmapBytes {
  public:
    ColmapBytes(std::string_view bytes, const std::string& origin)
        : bytes_(bytes), origin_(origin) {}

    template <class T>
    T take() {
        if (bytes_.size() < sizeof(T)) end_early();
        T value{};
        std::memcpy(&value, bytes_.data(), sizeof(T));
        bytes_.remove_prefix(sizeof(T));
        return value;
    }
    std::string take_name() {
        const std::size_t end = bytes_.find('\0');
        if (end == std::string_view::npos) end_early();
        std::string name(bytes_.substr(0, end));
        bytes_.remove_prefix(end + 1);
        return name;
    }
    void skip(std::uint64_t count, std::size_t size) {
        if (count > bytes_.size() / size) end_early();
        bytes_.remove_prefix(static_cast<std::size_t>(count) * size);
    }

  private:
    [[noreturn]] void end_early() const {
        throw InputError(fmt::format(
            "{}: ends before what it announces; copy it again, or write it as images.txt",
            origin_));
    }

    std::string_view bytes_;
    const std::string& origin_;
};

std::vector<NamedPose> read_colmap_binary(std::string_view bytes, const std::string& origin) {
    ColmapBytes file(bytes, origin);
    const auto count = file.take<std::uint64_t>();
    std::vector<NamedPose> named;
    for (std::uint64_t i = 0; i < count; ++i) {
        // Messages count images where those of other formats count lines.
        const PoseLine image{origin, named.size() + 1};
        check_count(image, named.size());
        file.take<std::uint32_t>();  // the image's number
        std::array<double, 7> v{};
        for (double& number : v) {
            number = file.take<double>();
            if (!(std::abs(number) <= k_max_pose_number))
                image.fail("has a number that is none, or above 1e12");
        }
        file.take<std::uint32_t>();  // the camera's
        const Affine camera_from_world{image.rotation(v[0], v[1], v[2], v[3]).matrix(),
                                       Vector3(v[4], v[5], v[6])};
        named.push_back({file.take_name(), pose_of(camera_from_world.inverse()), image.number});
        constexpr std::size_t k_point_bytes = 24;  // x, y, and the point's number
        file.skip(file.take<std::uint64_t>(), k_point_bytes);
    }
    return named;
}

// Files have six digits and more, some after a scale was taken out.
constexpr double k_rigid_tolerance = 1e-3;

/// One of the file's frames, for messages.
class NerfstudioFrame {
  public:
    NerfstudioFrame(const Json& frame, std::size_t index, const std::string& origin)
        : frame_(frame), index_(index), origin_(origin) {}

    NamedPose read() const {
        if (!frame_.is_object() || !frame_.contains("transform_matrix"))
            fail("has no transform_matrix");
        const Json& rows = frame_["transform_matrix"];
        if (!rows.is_array() || (rows.size() != 4 && rows.size() != 3))
            fail("its transform_matrix has not four rows of four numbers");
        Matrix3 linear(0.0);
        Vector3 offset(0.0);
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (std::size_t j = 0; j < 4; ++j) {
                const double x = number(rows[i], j);
                if (i == 3) {
                    if (std::abs(x - (j == 3 ? 1 : 0)) > k_rigid_tolerance)
                        fail("its transform_matrix does not end in 0, 0, 0, 1");
                } else if (j == 3) {
                    offset[static_cast<int>(i)] = x;
                } else {
                    linear[static_cast<int>(j)][static_cast<int>(i)] = x;
                }
            }
        check_rotation(linear);
        // y up and -z forward become y down and z forward.
        linear[1] = -linear[1];
        linear[2] = -linear[2];
        return {name(), {at_origin_plus(offset), rotation_of(linear)}, index_};
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(fmt::format("{}: frames[{}]: {}", origin_, index_, what));
    }

    double number(const Json& row, std::size_t j) const {
        if (!row.is_array() || row.size() != 4 || !row[j].is_number())
            fail("its transform_matrix has not four rows of four numbers");
        const double x = row[j].get<double>();
        if (!(std::abs(x) <= k_max_pose_number))
            fail("its transform_matrix has a number above 1e12");
        return x;
    }

    void check_rotation(const Matrix3& linear) const {
        const Matrix3 product = glm::transpose(linear) * linear;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                if (!(std::abs(product[i][j] - (i == j ? 1 : 0)) <= k_rigid_tolerance))
                    fail("its transform_matrix is not rigid to within 1e-3; take out its scale");
        if (glm::determinant(linear) < 0) fail("its transform_matrix mirrors the world");
    }

    /// The image's; a frame without one is called by its place.
    std::string name() const {
        const auto found = frame_.find("file_path");
        if (found == frame_.end()) return fmt::format("{:09}", index_);
        if (!found->is_string()) fail("its file_path is no text");
        return found->get<std::string>();
    }

    const Json& frame_;
    std::size_t index_;
    const std::string& origin_;
};

// nerfstudio's transforms.json.
std::vector<NamedPose> read_nerfstudio(std::string_view text, const std::string& origin) {
    Json json;
    try {
        json = Json::parse(text);
    } catch (const Json::exception& error) {
        throw InputError(fmt::format("{}: is not JSON: {}", origin, printable(error.what(), 200)));
    }
    const auto frames = json.is_object() ? json.find("frames") : json.end();
    if (!json.is_object() || frames == json.end() || !frames->is_array())
        throw InputError(
            fmt::format("{}: has no list 'frames', as nerfstudio's transforms.json has", origin));
    if (frames->size() > k_max_poses)
        throw InputError(
            fmt::format("{}: has more than a million poses; give those that are needed", origin));
    std::vector<NamedPose> named;
    for (std::size_t i = 0; i < frames->size(); ++i)
        named.push_back(NerfstudioFrame((*frames)[i], i, origin).read());
    return named;
}

// COLMAP's images.txt consists almost entirely of points, so that it may be large.
constexpr std::size_t k_max_bytes = std::size_t{1} << 30;

std::string_view without_mark(std::string_view text) {
    constexpr std::string_view k_byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(k_byte_order_mark)) text.remove_prefix(k_byte_order_mark.size());
    return text;
}

/// In alphabetical order of the names; at least one.
std::vector<NamedPose> named_poses(const std::string& text, bool is_binary, PoseFormat format,
                                   const std::string& origin) {
    std::vector<NamedPose> named = format == PoseFormat::nerfstudio
                                       ? read_nerfstudio(without_mark(text), origin)
                                   : is_binary ? read_colmap_binary(text, origin)
                                               : read_colmap_images(without_mark(text), origin);
    sort_by_name(named, origin);
    return named;
}

PoseFile read_text(const std::string& text, bool is_binary, PoseFormat format,
                   const std::string& origin) {
    if (format == PoseFormat::tum) return read_tum(without_mark(text), origin);
    if (format == PoseFormat::euroc) return read_euroc(without_mark(text), origin);
    PoseFile file;
    file.counts_frames = true;
    file.poses = by_frame(named_poses(text, is_binary, format, origin));
    return file;
}

/// The content of a file of poses, and what messages about it begin with.
struct PoseText {
    std::string origin, text;
    bool is_binary = false;

    PoseText(const std::filesystem::path& file, const std::string& subject)
        : origin(fmt::format("{}: {}", subject, printable(file.string(), 300))),
          text(read_text_file(file, origin, k_max_bytes, "file of poses")),
          is_binary(file.extension() == ".bin") {}
};

}  // namespace

PoseFile read_pose_file(const std::filesystem::path& file, PoseFormat format,
                        const std::string& subject) {
    const PoseText read(file, subject);
    PoseFile poses = read_text(read.text, read.is_binary, format, read.origin);
    if (poses.poses.empty()) throw InputError(read.origin + ": has no pose");
    poses.hash = text_hash(read.text);
    return poses;
}

std::vector<NamedPose> read_named_poses(const std::filesystem::path& file, PoseFormat format,
                                        const std::string& subject) {
    const PoseText read(file, subject);
    std::vector<NamedPose> named = named_poses(read.text, read.is_binary, format, read.origin);
    if (named.empty()) throw InputError(read.origin + ": has no pose");
    return named;
}

std::optional<PoseFormat> pose_format_called(const std::filesystem::path& file) {
    const std::string extension = file.extension().string();
    if (extension == ".tum") return PoseFormat::tum;
    if (extension == ".csv") return PoseFormat::euroc;
    if (extension == ".json") return PoseFormat::nerfstudio;
    if (file.filename() == "images.txt" || file.filename() == "images.bin")
        return PoseFormat::colmap;
    return std::nullopt;
}

Pose placed(const Pose& pose, const TrajectoryDesc& desc) {
    const Point3 scaled = at_origin_plus(desc.scale * from_origin(pose.position));
    return {desc.world_from_file * scaled, pose_of(desc.world_from_file).rotation * pose.rotation};
}

namespace {

/// The file's time that is the scene's time 0 [ns]. Precondition: the file has times.
std::int64_t zero_of(const PoseFile& file, const TrajectoryDesc& desc) {
    if (!desc.start) return file.stamps.front();
    const auto zero = nanoseconds(*desc.start);
    if (!zero)
        throw InputError(fmt::format(
            "{}.start: {:g} s is after the year 2116; give the file's time that is the scene's "
            "time 0, in seconds",
            desc.where, *desc.start));
    return *zero;
}

/// From the file's world and times to the scene's.
std::vector<TimedPose> all_placed(const PoseFile& file, const TrajectoryDesc& desc, double fps) {
    const std::int64_t zero = file.stamps.empty() ? 0 : zero_of(file, desc);
    std::vector<TimedPose> poses;
    poses.reserve(file.poses.size());
    for (std::size_t i = 0; i < file.poses.size(); ++i) {
        const double time =
            file.stamps.empty() ? file.poses[i].time / fps : seconds_between(zero, file.stamps[i]);
        poses.push_back({time, placed(file.poses[i].pose, desc)});
    }
    return poses;
}

}  // namespace

std::optional<std::int64_t> nanoseconds(double seconds) {
    // The parts of a second apart: their product with 1e9 is rounded to a nanosecond, that of a
    // Unix time to 128.
    const double whole = std::floor(seconds);
    if (!(std::abs(whole) < static_cast<double>(k_last_stamp) / 1e9)) return std::nullopt;
    return static_cast<std::int64_t>(whole) * 1'000'000'000 + std::llround((seconds - whole) * 1e9);
}

namespace {

/// A doubt about the times of a file whose frame n is shown at n/fps seconds; empty if they are
/// plausible. A few whole numbers from 0 or 1 on may be anything.
std::string doubt_of_times(const std::vector<std::int64_t>& stamps, double fps) {
    constexpr std::int64_t k_second = 1'000'000'000;
    constexpr std::size_t k_few = 10;
    if (stamps.size() < 2) return "";
    const double duration = seconds_between(stamps.front(), stamps.back());
    if (duration * fps < 1)
        return fmt::format(
            "all of its {} poses lie within {:.3g} s, less than a frame at render.fps: {:g}; check "
            "the unit of its times, or write render.times: trajectory if each pose is a frame",
            stamps.size(), duration, fps);
    const bool counts =
        stamps.size() >= k_few && (stamps.front() == 0 || stamps.front() == k_second) &&
        std::ranges::all_of(stamps, [](std::int64_t ns) { return ns % k_second == 0; });
    if (!counts) return "";
    const std::int64_t step =
        (stamps.back() - stamps.front()) / static_cast<std::int64_t>(stamps.size() - 1) / k_second;
    const bool is_even = std::ranges::adjacent_find(stamps, [](std::int64_t a, std::int64_t b) {
                             return b - a != k_second;
                         }) == stamps.end();
    constexpr std::int64_t k_long = 10;
    if (is_even && fps != 1)
        return fmt::format(
            "its times are {0}, {1}, {2}, ..., as the numbers of frames are, and mean seconds: its "
            "path takes {3:g} s, {4:.0f} frames at render.fps: {5:g}; if they are frames, divide "
            "them by the frames per second, or write render.times: trajectory and render.fps: 1",
            stamps[0] / k_second, stamps[1] / k_second, stamps[2] / k_second, duration,
            duration * fps + 1, fps);
    if (step >= k_long)
        return fmt::format(
            "its times are whole numbers, {} apart, and mean seconds: its path takes {:g} s; "
            "divide times in milliseconds by 1000",
            step, duration);
    return "";
}

}  // namespace

std::string load_trajectory(TrajectoryDesc& desc, double fps, std::string& doubt) {
    if (desc.file.empty()) {
        desc.trajectory =
            std::make_shared<Trajectory>(desc.keyframes, desc.interpolation, desc.pacing);
        return {};
    }
    const PoseFile file = read_pose_file(desc.file, desc.format, desc.where);
    const std::vector<TimedPose> poses = all_placed(file, desc, fps);
    if (const auto fault = Trajectory::first_fault(poses, desc.pacing)) {
        if (!(poses[*fault].time > poses[*fault - 1].time))
            throw InputError(fmt::format(
                "{}.start: is so far from poses {} and {} of '{}' that seconds after it are the "
                "same for both; give a time near that of the first pose",
                desc.where, *fault, *fault + 1, desc.file.filename().string()));
        throw InputError(fmt::format(
            "{}: poses {} and {} of '{}' are at the same place, where no time passes at the given "
            "speed; leave 'speed' out",
            desc.where, *fault, *fault + 1, desc.file.filename().string()));
    }
    desc.trajectory = std::make_shared<Trajectory>(poses, desc.interpolation, desc.pacing);
    doubt = doubt_of_times(file.stamps, fps);
    return file.hash;
}

std::optional<PoseClock> read_pose_clock(const TrajectoryDesc& desc) {
    if (desc.file.empty() || desc.format == PoseFormat::colmap ||
        desc.format == PoseFormat::nerfstudio)
        return std::nullopt;
    PoseFile file = read_pose_file(desc.file, desc.format, desc.where);
    PoseClock clock{zero_of(file, desc), {}};
    if (desc.pacing.kind != Pacing::Kind::given) return clock;
    const std::vector<TimedPose> poses = all_placed(file, desc, 1);
    if (desc.trajectory &&
        !std::ranges::equal(poses, desc.trajectory->times(), {}, &TimedPose::time))
        throw InputError(fmt::format("{}: '{}' has changed since it was read; begin again",
                                     desc.where, desc.file.filename().string()));
    clock.stamps = std::move(file.stamps);
    return clock;
}
}  // namespace uw
