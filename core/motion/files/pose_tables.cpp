#include "core/motion/files/pose_tables.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>

#include "core/base/text.h"
#include "core/motion/files/pose_lines.h"

namespace uw {

namespace {

/// Takes the next line from the beginning of `text`, without blanks at its ends.
std::string_view take_line(std::string_view& text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    constexpr std::string_view k_blanks = " \t\r";
    const std::size_t first = line.find_first_not_of(k_blanks);
    if (first == std::string_view::npos) return {};
    return line.substr(first, line.find_last_not_of(k_blanks) - first + 1);
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
    if (poses >= k_most_poses)
        line.fail("the file has more than a million poses; give those that are needed");
}

void check_time(const PoseLine& line, const std::vector<TimedPose>& poses, double time) {
    if (poses.empty() || time > poses.back().time) return;
    line.fail(time == poses.back().time
                  ? "has the time of the pose before; give each its own"
                  : "its time is before that of the pose before; sort the file by time");
}

}  // namespace

PoseFile read_tum(std::string_view text, const std::string& origin) {
    PoseFile file;
    for (PoseLine line{origin, 1}; !text.empty(); ++line.number) {
        const std::string_view content = take_line(text);
        if (content.empty() || content.front() == '#') continue;
        const std::vector<std::string_view> cells = cells_of(content, " \t,");
        constexpr std::array<std::string_view, 8> k_columns{"timestamp", "tx", "ty", "tz",
                                                            "qx",        "qy", "qz", "qw"};
        if (cells.size() != k_columns.size())
            line.fail(fmt::format("expected the 8 columns timestamp tx ty tz qx qy qz qw, found {}",
                                  cells.size()));
        check_count(line, file.poses.size());
        std::array<double, 8> v{};
        for (std::size_t i = 0; i < v.size(); ++i) v[i] = line.parsed(cells[i], k_columns[i]);
        if (file.poses.empty()) file.first_time = v[0];
        const double time = v[0] - file.first_time;
        check_time(line, file.poses, time);
        file.poses.push_back({time, {{v[1], v[2], v[3]}, line.rotation(v[7], v[4], v[5], v[6])}});
    }
    return file;
}

PoseFile read_euroc(std::string_view text, const std::string& origin) {
    PoseFile file;
    std::int64_t first_ns = 0;
    for (PoseLine line{origin, 1}; !text.empty(); ++line.number) {
        const std::string_view content = take_line(text);
        if (content.empty() || content.front() == '#') continue;
        const std::vector<std::string_view> cells = cells_of(content, " \t,");
        constexpr std::array<std::string_view, 8> k_columns{"time", "x",  "y",  "z",
                                                            "qw",   "qx", "qy", "qz"};
        if (cells.size() < k_columns.size())
            line.fail(
                fmt::format("expected the 8 columns ns, x, y, z, qw, qx, qy, qz or more, found {}",
                            cells.size()));
        check_count(line, file.poses.size());
        std::int64_t ns = 0;
        const auto [end, error] =
            std::from_chars(cells[0].data(), cells[0].data() + cells[0].size(), ns);
        if (error != std::errc() || end != cells[0].data() + cells[0].size() || ns < 0)
            line.fail(fmt::format("expected the time in whole nanoseconds, found '{}'",
                                  printable(cells[0])));
        std::array<double, 8> v{};
        for (std::size_t i = 1; i < v.size(); ++i) v[i] = line.parsed(cells[i], k_columns[i]);
        if (file.poses.empty()) {
            first_ns = ns;
            file.first_time = static_cast<double>(ns) * 1e-9;
        }
        // The difference of whole numbers: a double in seconds resolves 200 ns of a Unix time.
        const double time = static_cast<double>(ns - first_ns) * 1e-9;
        check_time(line, file.poses, time);
        file.poses.push_back({time, {{v[1], v[2], v[3]}, line.rotation(v[4], v[5], v[6], v[7])}});
    }
    return file;
}

PoseFile read_colmap_images(std::string_view text, const std::string& origin) {
    std::vector<NamedPose> named;
    for (PoseLine line{origin, 1}; !text.empty(); ++line.number) {
        const std::string_view content = take_line(text);
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
    PoseFile file;
    file.counts_frames = true;
    file.poses = by_frame(std::move(named), origin);
    return file;
}

}  // namespace uw
