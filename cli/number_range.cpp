#include "cli/number_range.h"

#include <array>
#include <cmath>
#include <vector>

#include "core/base/text.h"

namespace uw {

double NumberRange::count() const {
    return std::floor(std::abs((last - first) / step) + 1e-9) + 1;
}

double NumberRange::at(int i) const {
    return first + i * std::copysign(step, last - first);
}

std::optional<NumberRange> number_range_in(std::string_view text) {
    const std::vector<std::string_view> parts = split(text, ':');
    std::array<double, 3> numbers{};
    if (parts.size() != numbers.size()) return std::nullopt;
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (parse_number(parts[i], numbers[i]) != NumberText::number) return std::nullopt;
    return NumberRange{numbers[0], numbers[1], numbers[2]};
}

}  // namespace uw
