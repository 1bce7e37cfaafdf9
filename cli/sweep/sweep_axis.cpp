#include "cli/sweep/sweep_axis.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

namespace {

constexpr double k_most_values = 1000;

/// The numbers of "first:last:step"; none if `text` is something else.
std::optional<std::array<double, 3>> range_in(std::string_view text) {
    std::array<double, 3> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const std::size_t end = text.find(':');
        const bool is_last = i + 1 == numbers.size();
        if ((end == std::string_view::npos) != is_last) return std::nullopt;
        if (parse_number(text.substr(0, end), numbers[i]) != NumberText::number)
            return std::nullopt;
        if (!is_last) text.remove_prefix(end + 1);
    }
    return numbers;
}

}  // namespace

std::string SweepAxis::override_at(std::size_t index) const {
    return fmt::format("{}={}", key, values[index]);
}

std::optional<SweepAxis> sweep_axis(const std::string& override) {
    const std::size_t equals = override.find('=');
    if (equals == std::string::npos) return std::nullopt;
    const auto range = range_in(std::string_view(override).substr(equals + 1));
    if (!range) return std::nullopt;
    const auto [first, last, step] = *range;
    const auto fail = [&](const char* what) {
        throw UsageError(fmt::format("--set {}: {}", printable(override, 200), what));
    };
    if (step == 0) fail("the step is 0; give FIRST:LAST:STEP, such as -1.2:-0.2:0.2");
    // The ends belong to it, though their distance be a multiple of the step up to rounding only.
    const double count = std::floor(std::abs((last - first) / step) + 1e-9) + 1;
    if (count > k_most_values) fail("more than 1000 values; give a larger step");
    if (count < 2) fail("the step is larger than the range; give a smaller one");
    SweepAxis axis{override.substr(0, equals), {}};
    const double signed_step = std::copysign(step, last - first);
    for (int i = 0; i < static_cast<int>(count); ++i) {
        // As decimal numbers are meant: 0.3, not 0.30000000000000004.
        double value = 0;
        parse_number(fmt::format("{:.12g}", first + i * signed_step), value);
        axis.values.push_back(value);
    }
    return axis;
}

}  // namespace uw
