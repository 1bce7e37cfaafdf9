#include "core/scene/text/number_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/base/text.h"

namespace uw {
namespace {

std::string fixed_text(double value) {
    std::array<char, 400> digits{};  // the smallest number has 343 of them
    const auto end =
        std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed)
            .ptr;
    return {digits.data(), end};
}

}  // namespace

std::string number_text(double value, const NumberStyle& style) {
    if (style.decimals) {
        const std::string rounded = fmt::format("{:.{}f}", value, *style.decimals);
        if (double again = 0; parse_number(rounded, again) == NumberText::number) value = again;
    }
    if (value == 0) return "0";  // not -0
    const double size = std::abs(value);
    if (size >= 1e-6 && size < 1e15) return fixed_text(value);
    std::array<char, 40> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                   std::chars_format::scientific)
                         .ptr;
    std::string text(digits.data(), end);
    const std::size_t exponent = text.find('e') + 2;  // behind its sign
    text.erase(exponent,
               std::min(text.find_first_not_of('0', exponent), text.size() - 1) - exponent);
    return text;
}

std::string numbers_text(std::span<const double> values, const NumberStyle& style) {
    std::string text = "[";
    for (const double value : values)
        text += (text.size() > 1 ? ", " : "") + number_text(value, style);
    return text + "]";
}

}  // namespace uw
