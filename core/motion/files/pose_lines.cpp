#include "core/motion/files/pose_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

namespace {

// Files have four digits and more.
constexpr double k_unit_tolerance = 1e-3;
constexpr double k_last_frame = 999'999'999;

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

}  // namespace

void PoseLine::fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", origin, number, what));
}

double PoseLine::parsed(std::string_view cell, std::string_view name) const {
    double value = 0;
    if (parse_number(cell, value) != NumberText::number || std::abs(value) > k_largest_pose_number)
        fail(fmt::format("{}: expected a number of at most 1e12, found '{}'", name,
                         printable(cell)));
    return value;
}

Rotation PoseLine::rotation(double w, double x, double y, double z) const {
    const double length = std::sqrt(w * w + x * x + y * y + z * z);
    if (!(std::abs(length - 1) <= k_unit_tolerance))
        fail(fmt::format("the quaternion has length {:.6g}, not 1; check the order of the columns",
                         length));
    return normalised({w, x, y, z});
}

std::vector<TimedPose> by_frame(std::vector<NamedPose> named, const std::string& origin) {
    std::ranges::sort(named, {}, &NamedPose::name);
    const auto twin = std::ranges::adjacent_find(named, {}, &NamedPose::name);
    if (twin != named.end())
        PoseLine{origin, std::max(twin->line, (twin + 1)->line)}.fail(fmt::format(
            "the image '{}' is there twice; give each its own name", printable(twin->name)));
    std::vector<TimedPose> poses;
    poses.reserve(named.size());
    for (const NamedPose& pose : named)
        poses.push_back({static_cast<double>(poses.size()), pose.pose});
    std::vector<TimedPose> by_number = poses;
    return number_by_names(named, by_number) ? by_number : poses;
}

}  // namespace uw
