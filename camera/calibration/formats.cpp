#include "camera/calibration/formats.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

ConfigValue require_value(const ConfigValue& map, std::string_view key, std::string_view mend) {
    const ConfigNode* const node = map.node().find(key);
    if (node == nullptr) map.fail(fmt::format("'{}' is missing; {}", key, mend));
    const std::string path =
        map.path().empty() ? std::string(key) : fmt::format("{}.{}", map.path(), key);
    return {*node, path};
}

std::string number_list(std::span<const double> numbers) {
    return fmt::format("[{}]", fmt::join(numbers, ", "));
}

std::string some_names(const std::vector<std::string>& names) {
    constexpr std::size_t k_most = 8;
    std::vector<std::string> some;
    for (std::size_t i = 0; i < std::min(names.size(), k_most); ++i)
        some.push_back(printable(names[i], 30));
    return fmt::format("{}{}", fmt::join(some, ", "), names.size() > k_most ? ", ..." : "");
}

std::string choose_camera(const std::vector<std::string>& names, const std::string& wanted,
                          const std::string& where) {
    if (names.empty()) throw InputError(where + ": contains no camera; give another file");
    if (wanted.empty()) {
        if (names.size() == 1) return names.front();
        throw InputError(fmt::format(
            "{}: has {} cameras ({}); choose one: calibration: {{file: ..., camera: {}}} in a "
            "scene, --camera {} on the command line",
            where, names.size(), some_names(names), printable(names.front(), 30),
            printable(names.front(), 30)));
    }
    if (std::ranges::find(names, wanted) != names.end()) return wanted;
    throw InputError(fmt::format("{}: has no camera '{}'; it has {}", where, printable(wanted),
                                 some_names(names)));
}

bool is_distorted(const DistortionDesc& distortion) {
    return has_radial_above(distortion, 0) || distortion.p[0] != 0 || distortion.p[1] != 0;
}

bool has_radial_above(const DistortionDesc& distortion, std::size_t count) {
    return std::any_of(distortion.k.begin() + static_cast<std::ptrdiff_t>(count),
                       distortion.k.end(), [](double k) { return k != 0; });
}

}  // namespace uw
